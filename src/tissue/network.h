// A body of mass points joined by springs along the edges of tetrahedra.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "geometry/tet_mesh.h"

namespace palpate::tissue {

// The six springs of a tetrahedron where they pull on each other: their tensions are this matrix
// times their elongations.                                                docs/theory.md (65)
struct CoupledSprings {
  std::array<int, 6> springs{};
  Eigen::Matrix<double, 6, 6> stiffness;  // N/m, symmetric
};

// A pressure against the change of a volume, which is averaged over the tetrahedra around a node:
// the energy is 1/2 stiffness (sum of dilation * elongation over its springs)^2.
//                                                                         docs/theory.md (66)
struct SharedVolume {
  std::vector<int> springs;
  std::vector<double> dilation;  // 1/m, one a spring
  double stiffness = 0.0;        // N m: modulus (Pa) times volume (m^3)
};

// Built once and constant. Springs are numbered as the mesh's sorted edges. A spring's tension is
// its own stiffness times its elongation, and what its tetrahedra and volumes add.
struct Network {
  std::vector<Vec3> rest;                // m, one a node
  std::vector<double> node_mass;         // kg, a quarter of each tetrahedron at its corners
  std::vector<std::array<int, 2>> ends;  // nodes of a spring, the lower first
  std::vector<double> rest_length;       // m
  std::vector<Vec3> direction;           // unit vector from the first end to the second, at rest
  std::vector<double> stiffness;         // N/m, of each by itself
  std::vector<CoupledSprings> coupled;
  std::vector<SharedVolume> volumes;

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
