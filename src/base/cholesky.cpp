// Eigen's simplicial factorisation: serial, no BLAS, the same bits everywhere.
#include "base/cholesky.h"

#include <Eigen/SparseCholesky>

namespace palpate {

struct Cholesky::Factors {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver;
  Eigen::Index nonzeros = -1;
};

Cholesky::Cholesky() : factors_(std::make_unique<Factors>()) {}
Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;

bool Cholesky::factor(const Eigen::SparseMatrix<double>& matrix) {
  if (matrix.nonZeros() != factors_->nonzeros) {
    factors_->solver.analyzePattern(matrix);
    factors_->nonzeros = matrix.nonZeros();
  }
  factors_->solver.factorize(matrix);
  return factors_->solver.info() == Eigen::Success;
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  return factors_->solver.solve(b);
}

}  // namespace palpate
