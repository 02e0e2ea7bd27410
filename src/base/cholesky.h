// A sparse Cholesky factorisation that is ordered once and reused.
#pragma once

#include <memory>
#include <mutex>

#include "base/block_matrix.h"

namespace palpate {

// Held by whoever calls METIS.
std::mutex& metis_lock();

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  // Factors a symmetric positive definite matrix. The fill-reducing order is kept as long as the
  // pattern of nonzeros stays the same. Returns false if the matrix is not positive definite, is
  // singular up to rounding, or contains a number that is not finite. Also returns false if `local`
  // alone is singular: `shared` may add stiffness, but not support a free motion of `local`.
  [[nodiscard]] bool factor(const SplitMatrix& matrix);

  // Solves A x = b with the factors of the last call of factor(), which must have returned true.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  // The same; allocates nothing after the first call. `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace palpate
