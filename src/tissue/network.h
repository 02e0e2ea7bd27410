// A body of point masses joined by springs along the edges of tetrahedra: elongations from
// displacements, forces and stiffness from tensions, and the highest frequency, which limits the
// explicit time step.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/block_matrix.h"
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

// linear: elongations and forces along the directions at rest (Chen 2007 eq. 11-12).
// nonlinear: with current lengths and directions (eq. 10).           docs/theory.md [elongation]
// squared: e = (|r|^2 - l^2) / (2 l), a tetrahedron's six make up Green's strain [coupled].
enum class Kinematics { linear, nonlinear, squared };

using Vector = Eigen::VectorXd;

// Displacements and forces are vectors with three entries (x, y, z) per node.

// The tensions (N) of springs with these elongations (m). Overwrites `tension`.
void tensions(const Network& network, std::span<const double> elongation,
              std::span<double> tension);

// The directions of the spring forces: unit vectors (linear), or span / rest length (non-linear).
void directions(const Network& network, Kinematics kinematics, const Vector& displacement,
                std::span<Vec3> direction);

// The forces of a tetrahedron's springs on its corners per tension, three rows per corner and one
// column per spring, for given directions of all springs of the network.
struct ElementPulls {
  std::array<int, 4> corners{};
  Eigen::Matrix<double, 12, 6> along = Eigen::Matrix<double, 12, 6>::Zero();
};
[[nodiscard]] ElementPulls element_pulls(const Network& network, const CoupledSprings& six,
                                         std::span<const Vec3> direction);

// The change of an averaged volume per displacement of each of its nodes, 1/m, by ascending nodes,
// for given directions of all springs of the network.
void changes_of(const Network& network, const SharedVolume& volume, std::span<const Vec3> direction,
                std::vector<std::pair<int, Vec3>>& changes);

// The matrix of [tangent], N/m, without supports: a change of elongations changes the tensions by
// `factor` times its tensions(). Unless kinematics are linear, which need neither `displacement`
// nor `tension` (N), the latter adds the geometric term of stretched springs; compressed springs
// add none, so that the matrix stays positive definite.
[[nodiscard]] BlockMatrix tangent(const Network& network, Kinematics kinematics,
                                  const Vector& displacement, double factor,
                                  std::span<const double> tension);

// The stiffness at rest, N/m.
[[nodiscard]] BlockMatrix stiffness_matrix(const Network& network);

// Whether a tetrahedron is turned inside out by the displacement.
[[nodiscard]] bool inverted(const geometry::TetMesh& mesh, const Vector& displacement);

// An upper bound of omega_max^2, 1/s^2: max over nodes of sum_j |K_ij| / m_i, with K_ij the 3 x 3
// blocks of each spring, tetrahedron and volume taken separately; 2 sum_j k_ij / m_i for
// independent springs. Needs no assembled matrix. docs/theory.md [limit]
[[nodiscard]] double safe_frequency_squared(const Network& network);

// The largest eigenvalue omega_max^2 (1/s^2) of M^-1 K without the held degrees of freedom, by
// largest_eigenpair(). The residual, at most 1e-6 of it (1e-4 on large bodies), is added, so that
// the result is at least the eigenvalue found; it never exceeds safe_frequency_squared(). Throws
// MeshError like that.                                                  docs/theory.md [limit]
[[nodiscard]] double largest_frequency_squared(const Network& network, std::span<const char> held);

// Pseudo-random numbers in [-1/2, 1/2), the same on every machine.
[[nodiscard]] Vector scattered(Eigen::Index size);

}  // namespace palpate::tissue
