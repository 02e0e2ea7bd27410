// A body of mass points joined by springs along the edges of tetrahedra.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "geometry/tet_mesh.h"

namespace palpate::tissue {

// Built once and constant. Springs are numbered as the mesh's sorted edges.
struct Network {
  std::vector<Vec3> rest;                // m, one a node
  std::vector<double> node_mass;         // kg, a quarter of each tetrahedron at its corners
  std::vector<std::array<int, 2>> ends;  // nodes of a spring, the lower first
  std::vector<double> rest_length;       // m
  std::vector<Vec3> direction;           // unit vector from the first end to the second, at rest
  std::vector<double> stiffness;         // N/m

  [[nodiscard]] int nodes() const { return static_cast<int>(rest.size()); }
  [[nodiscard]] int springs() const { return static_cast<int>(ends.size()); }
};

// Nodes, masses and springs of a mesh; `density` in kg/m^3, one a region of the mesh; `stiffness`
// one a sorted edge, N/m.
[[nodiscard]] Network make_network(const geometry::TetMesh& mesh, std::span<const double> density,
                                   std::vector<double> stiffness);

// At each node a quarter of the volume (m^3) of each tetrahedron that it is a corner of, times the
// weight of the tetrahedron's region.
[[nodiscard]] std::vector<double> node_volumes(const geometry::TetMesh& mesh,
                                               std::span<const double> weight);

}  // namespace palpate::tissue
