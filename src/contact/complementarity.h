// Many points that can be pressed but not pulled: which of them touch, and with what force.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::contact {

// The forces f >= 0 (N) with gaps g = gap + compliance f >= 0 (m), of which one is zero at every
// point. `compliance` is n x n, m/N, symmetric and positive definite: there is one answer.
// docs/theory.md (70)
// `pressed` holds a first guess of who touches, and then who does; `force` receives the answer.
// False where the compliance is not positive definite.
//
// Block principal pivoting: all points on the wrong side change it at once; where their number no
// longer falls, one at a time, which always ends (Judice and Pires 1994, Computers & Operations
// Research 21, 587; Murty 1974, Opsearch 11, 38).
[[nodiscard]] bool press_apart(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                               std::vector<char>& pressed, Eigen::VectorXd& force);

}  // namespace palpate::contact
