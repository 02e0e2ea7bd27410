// Linear least squares with coefficients of 0 or more.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace palpate::fit {

// The x >= 0 that minimises |A x - b|, by the active set of Lawson and Hanson, Solving Least
// Squares Problems, 1974, chapter 23. `a` has at least as many rows as columns. Nothing if the
// active set has not settled after 3 changes per column.
[[nodiscard]] std::optional<Eigen::VectorXd> nonnegative_least_squares(const Eigen::MatrixXd& a,
                                                                       const Eigen::VectorXd& b);

}  // namespace palpate::fit
