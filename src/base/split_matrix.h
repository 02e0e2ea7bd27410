// A symmetric sparse matrix, a part of which is kept as a product.
#pragma once

#include <Eigen/SparseCore>

namespace palpate {

// A = local + shared^T diag(weights) shared. If the rows of `shared` are long, multiplying them out
// would fill in the matrix. Without such a part `shared` has no rows.
struct SplitMatrix {
  Eigen::SparseMatrix<double> local;   // n x n
  Eigen::SparseMatrix<double> shared;  // m x n
  Eigen::VectorXd weights;             // size m, no zeros

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
