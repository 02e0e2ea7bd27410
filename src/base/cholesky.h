// A sparse Cholesky factorisation that is ordered once and reused.
#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace palpate {

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  // Factors a symmetric positive definite matrix; the fill-reducing order is kept as long as the
  // pattern of nonzeros stays the same size. Returns false where the matrix is not positive
  // definite (or not finite).
  [[nodiscard]] bool factor(const Eigen::SparseMatrix<double>& matrix);

  // Solves A x = b with the last factors.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace palpate
