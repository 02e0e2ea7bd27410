// The largest eigenvalue of a symmetric matrix that is known by its products, by Spectra.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace palpate {

struct EigenPair {
  double value = 0.0;
  Eigen::VectorXd vector;  // of unit length
};

// Lanczos's method with implicit restarts (Calvetti, Reichel & Sorensen 1994) from `start`, on
// which all bits of the result depend, until the residual is at most `tolerance` of the eigenvalue.
// `multiply(x, image)` fills `image`. Keeps 20 vectors. Throws MeshError if 10000 products are not
// enough.
[[nodiscard]] EigenPair largest_eigenpair(
    const Eigen::VectorXd& start, double tolerance,
    const std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>& multiply);

}  // namespace palpate
