// What springs do: elongations from displacements, forces and stiffness from tensions.
#pragma once

#include <span>
#include <vector>

#include "base/split_matrix.h"
#include "tissue/network.h"

namespace palpate::tissue {

// linear: elongations by the rest directions, forces along them (eq. 11-12).
// nonlinear: lengths and directions of the moment (eq. 10).
// squared: e = (|r|^2 - l^2) / (2 l), which six springs of a tetrahedron turn into Green's strain.
enum class Kinematics { linear, nonlinear, squared };

using Vector = Eigen::VectorXd;

// Displacements and forces are vectors of three times the nodes, x, y, z of a node together.

// e_s in m for displacements u (m).
void elongations(const Network& network, Kinematics kinematics, const Vector& displacement,
                 std::span<double> elongation);

// Tensions (N) of springs with these elongations (m). Overwrites `tension`.
void tensions(const Network& network, std::span<const double> elongation,
              std::span<double> tension);

// What the tensions of some elongations do along other elongations, J; symmetric in both.
[[nodiscard]] double work(const Network& network, std::span<const double> elongation,
                          std::span<const double> along);
// The same with room for the tensions.
[[nodiscard]] double work(const Network& network, std::span<const double> elongation,
                          std::span<const double> along, std::vector<double>& tension);

// f = sum over springs of tension (N) along the spring's direction, the gradient of the elastic
// energy: what holds the displacement in balance is +f. Overwrites `force`.
void gather_forces(const Network& network, Kinematics kinematics, const Vector& displacement,
                   std::span<const double> tension, Vector& force);

// Unit vectors along which springs pull (of squared lengths: the span over the rest length).
void directions(const Network& network, Kinematics kinematics, const Vector& displacement,
                std::span<Vec3> direction);

// The rate of elongation by the velocity, m/s, along the directions of the moment.
void elongation_rates(const Network& network, Kinematics kinematics, const Vector& displacement,
                      const Vector& velocity, std::span<double> rate);

// The tangent matrix where tensions change by `factor` times tensions() of a change of elongations
// and, unless linear, the springs have these tensions (N); compressed springs give no geometric
// term, so that the matrix stays positive definite. Rows and columns of `held` degrees of freedom
// are those of the identity.
[[nodiscard]] SplitMatrix tangent(const Network& network, Kinematics kinematics,
                                  const Vector& displacement, double factor,
                                  std::span<const double> tension, std::span<const char> held);

// The stiffness at rest, N/m.
[[nodiscard]] SplitMatrix stiffness_matrix(const Network& network, std::span<const char> held);

// Whether any tetrahedron has turned inside out under the displacement.
[[nodiscard]] bool inverted(const geometry::TetMesh& mesh, const Vector& displacement);

}  // namespace palpate::tissue
