// What springs do: elongations from displacements, forces and stiffness from tensions.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "tissue/network.h"

namespace palpate::tissue {

// linear: elongations by the rest directions, forces along them (eq. 11-12).
// nonlinear: lengths and directions of the moment (eq. 10).
enum class Kinematics { linear, nonlinear };

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

// Displacements and forces are vectors of three times the nodes, x, y, z of a node together.

// e_s in m for displacements u (m).
void elongations(const Network& network, Kinematics kinematics, const Vector& displacement,
                 std::span<double> elongation);

// f = sum over springs of tension (N) along the spring's direction, the gradient of the elastic
// energy: what holds the displacement in balance is +f. Overwrites `force`.
void gather_forces(const Network& network, Kinematics kinematics, const Vector& displacement,
                   std::span<const double> tension, Vector& force);

// The rate of elongation by the velocity, m/s, along the directions of the moment.
void elongation_rates(const Network& network, Kinematics kinematics, const Vector& displacement,
                      const Vector& velocity, std::span<double> rate);

// The tangent matrix for springs of the given slopes d(tension)/d(elongation) (N/m) and, when
// nonlinear, tensions (N); compressed springs give no geometric term, so that the matrix stays
// positive definite. Rows and columns of `held` degrees of freedom are those of the identity.
[[nodiscard]] SparseMatrix tangent(const Network& network, Kinematics kinematics,
                                   const Vector& displacement, std::span<const double> slope,
                                   std::span<const double> tension, std::span<const char> held);

// Whether any tetrahedron has turned inside out under the displacement.
[[nodiscard]] bool inverted(const geometry::TetMesh& mesh, const Vector& displacement);

}  // namespace palpate::tissue
