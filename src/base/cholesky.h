// A sparse Cholesky factorisation that is ordered once and reused.
#pragma once

#include <memory>

#include "base/split_matrix.h"

namespace palpate {

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  // Factors a symmetric positive definite matrix; the fill-reducing order is kept as long as the
  // pattern of nonzeros stays the same. Returns false where the matrix is not positive definite, is
  // singular but for rounding, or is not finite; or where its local part alone is singular: rows
  // that are shared may stiffen it, but not hold what nothing else holds.
  [[nodiscard]] bool factor(const SplitMatrix& matrix);

  // Solves A x = b with the last factors.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  // The same; allocates nothing after the first time. `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace palpate
