// A body of point masses joined by springs along the edges of tetrahedra.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "geometry/tet_mesh.h"

namespace palpate::tissue {

// The six springs of a tetrahedron if they are coupled: their tensions are this matrix times their
// elongations.                                                       docs/theory.md [coupled]
struct CoupledSprings {
  std::array<int, 6> springs{};
  Eigen::Matrix<double, 6, 6> stiffness;  // N/m, symmetric
};

// A pressure against the change of a volume that is averaged over the tetrahedra around a node:
// the energy is 1/2 stiffness (sum of dilation * elongation over its springs)^2.
//                                                               docs/theory.md [nodal_volume]
struct SharedVolume {
  std::vector<int> springs;
  std::vector<double> dilation;  // 1/m, one per spring
  double stiffness = 0.0;        // N m: modulus (Pa) times volume (m^3)
  int node = -1;        // around which it is averaged; -1 if some of its springs are missing
  double volume = 0.0;  // m^3: of all tetrahedra around the node
};

// Built once and constant. Springs are numbered like the sorted edges of the mesh. The tension of a
// spring is its stiffness times its elongation plus the terms of its tetrahedra and volumes.
struct Network {
  std::vector<Vec3> rest;                // m, one per node
  std::vector<double> node_mass;         // kg; docs/theory.md [masses]
  std::vector<std::array<int, 2>> ends;  // nodes of a spring, the lower number first
  std::vector<double> rest_length;       // m
  std::vector<Vec3> direction;           // unit vector from the first end to the second, at rest
  std::vector<double> stiffness;         // N/m, of each spring alone
  std::vector<CoupledSprings> coupled;
  std::vector<SharedVolume> volumes;

  [[nodiscard]] int nodes() const { return static_cast<int>(rest.size()); }
  [[nodiscard]] int springs() const { return static_cast<int>(ends.size()); }
};

// Makes nodes, masses and springs of a mesh. `density` (kg/m^3) has one entry per region of the
// mesh, `stiffness` (N/m) one per sorted edge.
[[nodiscard]] Network make_network(const geometry::TetMesh& mesh, std::span<const double> density,
                                   std::vector<double> stiffness);

// For each node a quarter of the volume (m^3) of every tetrahedron at it, each multiplied by the
// weight of the tetrahedron's region.                                  docs/theory.md [masses]
[[nodiscard]] std::vector<double> node_volumes(const geometry::TetMesh& mesh,
                                               std::span<const double> weight);

struct Part {
  std::vector<int> nodes;    // numbers in the whole network, ascending: node i is nodes[i]
  std::vector<int> springs;  // numbers in the whole network, ascending
  std::vector<char> edge;    // one per node: 1 in the outermost ring, which is fixed
  Network network;
};

// The nodes at most `rings` springs away from `start`, and one more ring, which is the edge.
[[nodiscard]] Part part_around(const Network& whole, std::span<const int> start, int rings);

// The nodes of such a part, one flag per node of the whole network. Refilling allocates no memory.
struct Reach {
  std::vector<char> inside;  // in the part
  std::vector<char> moving;  // in the part and not in its edge
};
void reach_around(const Network& whole, std::span<const int> start, int rings, Reach& reach);
// Whether `part` has exactly these nodes and this edge.
[[nodiscard]] bool spans(const Part& part, const Reach& reach);

// The whole network as a part without an edge.
[[nodiscard]] Part whole_part(const Network& whole);

}  // namespace palpate::tissue
