// A body of mass points joined by springs along the edges of tetrahedra.
#pragma once

#include <array>
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

// Nodes, masses and springs of a mesh; `density` in kg/m^3; `stiffness` one a sorted edge, N/m.
[[nodiscard]] Network make_network(const geometry::TetMesh& mesh, double density,
                                   std::vector<double> stiffness);

// The volume around each node: a quarter of each tetrahedron that it is a corner of, m^3.
[[nodiscard]] std::vector<double> node_volumes(const geometry::TetMesh& mesh);

}  // namespace palpate::tissue
