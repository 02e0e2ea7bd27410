// Linear equations of a symmetric positive definite matrix, by factors or by iterations.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "base/block_matrix.h"
#include "base/cholesky.h"
#include "base/index.h"
#include "base/stop_scope.h"

namespace palpate {

// Entry `lane` of number d is at [lanes d + lane].
struct GradientVectors {
  Eigen::VectorXd right;  // b
  Eigen::VectorXd x;      // where iterations start, and the result
  Eigen::VectorXd r, p, image;
};

// Solves A x = b for a symmetric positive definite A. `multiply(x, y)` is y = A x, and
// `precondition(r, z)` is z = C r with a symmetric positive definite C that is near the inverse of
// A. `squared_error(lane, decrease, r.z)` gets by how much the squared error fell in an iteration,
// in the energy norm |x|^2 = x A x, and returns an estimate of it, negative if it has none yet.
// Iterations end where it is below `tolerance`^2 times the squared norm of the solution; `error`
// grows to its root over that norm. Returns false if A is seen not to be positive definite, or
// after `most` iterations.                                              Hestenes and Stiefel 1952
template <std::size_t lanes, class Multiply, class Precondition, class SquaredError>
[[nodiscard]] bool conjugate_gradients(GradientVectors& v, double tolerance, std::size_t most,
                                       const Multiply& multiply, const Precondition& precondition,
                                       const SquaredError& squared_error, double& error) {
  using Lanes = std::array<double, lanes>;
  const auto dot = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    Lanes sums{};
    for (Eigen::Index i = 0; i < a.size(); i += static_cast<Eigen::Index>(lanes))
      for (std::size_t l = 0; l < lanes; ++l) {
        const Eigen::Index k = i + static_cast<Eigen::Index>(l);
        sums[l] += a[k] * b[k];
      }
    return sums;
  };
  const auto add_scaled = [](const Lanes& factor, const Eigen::VectorXd& a, Eigen::VectorXd& to) {
    for (Eigen::Index i = 0; i < a.size(); i += static_cast<Eigen::Index>(lanes))
      for (std::size_t l = 0; l < lanes; ++l) {
        const Eigen::Index k = i + static_cast<Eigen::Index>(l);
        to[k] += factor[l] * a[k];
      }
  };
  multiply(v.x, v.image);
  v.r = v.right - v.image;
  precondition(v.r, v.p);
  Lanes rest = dot(v.r, v.p);
  std::array<bool, lanes> done{};
  for (std::size_t l = 0; l < lanes; ++l) done[l] = rest[l] == 0.0;
  for (std::size_t i = 0; !std::ranges::all_of(done, std::identity{}); ++i) {
    if (i == most) return false;
    StopScope::end_if_stopped();
    multiply(v.p, v.image);
    const Lanes work = dot(v.p, v.image);
    Lanes length{};
    Lanes shrink{};
    for (std::size_t l = 0; l < lanes; ++l) {
      if (done[l]) continue;
      if (!(work[l] > 0.0) || !std::isfinite(work[l])) return false;
      length[l] = rest[l] / work[l];
      shrink[l] = -length[l];
    }
    add_scaled(length, v.p, v.x);
    add_scaled(shrink, v.image, v.r);
    precondition(v.r, v.image);
    const Lanes next = dot(v.r, v.image);
    const Lanes energy = dot(v.right, v.x);  // x A x at the solution
    Lanes turn{};
    for (std::size_t l = 0; l < lanes; ++l) {
      if (done[l]) continue;
      const double squared = squared_error(l, length[l] * rest[l], next[l]);
      done[l] = next[l] == 0.0 ||
                (squared >= 0.0 && squared <= tolerance * tolerance * std::abs(energy[l]));
      if (done[l] && squared > 0.0)
        error = std::max(error, std::sqrt(squared / std::abs(energy[l])));
      turn[l] = next[l] / rest[l];
    }
    add_scaled(turn, v.p, v.image);
    v.p.swap(v.image);
    rest = next;
  }
  return true;
}

// The smooth part of a solution, by far fewer unknowns: the second level of a preconditioner.
// The nodes of a matrix in connected groups. Each group moves as one, by a translation of its
// degrees of freedom that are not held: with P, whose columns are these translations, C = P^T A P
// is small and is factored. Conjugate gradients with D^-1 + P C^-1 P^T in place of the diagonal's
// D^-1 take a number of iterations that depends on the size of a group only, and not on that of
// the matrix.                                                        Nicolaides 1987
class CoarseCorrection {
 public:
  // Returns false if C is not positive definite; then A is not either.
  [[nodiscard]] bool prepare(const BlockMatrix& matrix, std::span<const char> held);

  // z += P C^-1 P^T r for `lanes` vectors: entry l of degree of freedom d is r[stride d + l].
  void add(const Eigen::VectorXd& r, std::size_t lanes, std::size_t stride, Eigen::VectorXd& z);

 private:
  std::vector<int> free_;     // the degrees of freedom that are not held
  std::vector<int> unknown_;  // of C, for each of these
  Cholesky factors_;
  std::vector<double> gathered_;  // `stride` numbers per unknown of C
  Eigen::VectorXd load_, moved_;
};

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
