// Unilateral contact of many points, which transmit pressure but no tension: the contact forces.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::contact {

// Computes the forces f >= 0 (N) with gaps g = gap + compliance f >= 0 (m), one of the two being
// zero at every point. `compliance` is n x n, m/N, symmetric and positive definite, so that the
// solution is unique. `pressed` is a first guess of the points in contact and receives the points
// that are; `force` receives f. Returns false if the compliance is not positive definite.
//                                                                     docs/theory.md [unilateral]
// Block principal pivoting: all points with the wrong sign change their state at once, or one at a
// time when their number no longer falls, which terminates (Judice and Pires 1994, Computers &
// Operations Research 21, 587; Murty 1974, Opsearch 11, 38).
[[nodiscard]] bool press_apart(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                               std::vector<char>& pressed, Eigen::VectorXd& force);

}  // namespace palpate::contact
