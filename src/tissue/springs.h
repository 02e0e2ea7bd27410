// Spring mechanics: elongations from displacements, forces and stiffness from tensions.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/block_matrix.h"
#include "tissue/network.h"

namespace palpate::tissue {

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

}  // namespace palpate::tissue
