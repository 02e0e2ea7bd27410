// Linear equations of a symmetric positive definite matrix, by factors or by iterations.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/block_matrix.h"
#include "base/cholesky.h"
#include "base/coarse_correction.h"
#include "base/conjugate_gradients.h"

namespace palpate {

// Small matrices are factored. Large ones, whose factors would need far more time and memory than a
// few solutions, are solved by conjugate gradients with the diagonal as preconditioner; the error
// of a solution is estimated as Hestenes and Stiefel 1952 do, in the energy norm |x|^2 = x A x.
class SymmetricSolver {
 public:
  using Vector = Eigen::VectorXd;

  // Degrees of freedom from which a matrix counts as large. Measured on presses of blocks, time
  // with factors over that with iterations: 1 at 2000, 4 at 6000, more than 30 at 19 000.
  static constexpr Eigen::Index large = 3000;

  // `tolerance` is the error of a solution at which iterations end, as a fraction of its energy
  // norm.
  explicit SymmetricSolver(double tolerance = 1e-5) : tolerance_(tolerance) {}

  // Takes a matrix and the flags of the degrees of freedom that are held, whose solution is 0.
  // Returns false if the matrix is seen not to be positive definite; large ones only in solve().
  [[nodiscard]] bool prepare(BlockMatrix matrix, std::vector<char> held);
  [[nodiscard]] bool prepared() const { return !held_.empty(); }

  // Solves A x = b for several right-hand sides at once, whose entries at held degrees of freedom
  // are ignored. Iterations start at `x` where it has the size of `b`. Returns false if the matrix
  // is not positive definite.
  [[nodiscard]] bool solve(std::span<const Vector> b, std::span<Vector> x);
  [[nodiscard]] bool solve(const Vector& b, Vector& x) {
    return solve(std::span(&b, 1), std::span(&x, 1));
  }

  // z = C r with C near the inverse of A, and equal to it if it was factored; 0 where held.
  void precondition(const Vector& r, Vector& z);

  [[nodiscard]] double tolerance() const { return tolerance_; }
  void set_tolerance(double tolerance) { tolerance_ = tolerance; }

  // Without supports.
  [[nodiscard]] const BlockMatrix& matrix() const { return matrix_; }
  // The largest estimated error of any solution since forget_error(), a fraction of its energy
  // norm; 0 if the matrix was factored.
  [[nodiscard]] double error() const { return error_; }
  void forget_error() { error_ = 0.0; }

 private:
  [[nodiscard]] bool iterate(std::span<const Vector> b, std::span<Vector> x);

  double tolerance_;
  BlockMatrix matrix_;
  std::vector<char> held_;
  std::optional<Cholesky> factors_;
  Vector inverse_diagonal_;  // 0 where held
  std::optional<CoarseCorrection> coarse_;
  double error_ = 0.0;
  GradientVectors vectors_;
  Vector unheld_;
};

}  // namespace palpate
