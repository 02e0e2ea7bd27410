// A symmetric sparse matrix with a part that is kept as a product.
#pragma once

#include <Eigen/SparseCore>

namespace palpate {

// A = local + shared^T diag(weights) shared. The product of long rows would fill in; as a product
// it costs what its rows cost. Without such a part `shared` has no rows.
struct SplitMatrix {
  Eigen::SparseMatrix<double> local;   // n x n
  Eigen::SparseMatrix<double> shared;  // m x n
  Eigen::VectorXd weights;             // m, not zero

  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    Eigen::VectorXd y = local * x;
    if (weights.size() > 0) y += shared.transpose() * weights.cwiseProduct(shared * x);
    return y;
  }
  SplitMatrix& operator*=(double factor) {
    local *= factor;
    weights *= factor;
    return *this;
  }
};

}  // namespace palpate
