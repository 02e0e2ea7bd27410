// Factors of small matrices, conjugate gradients for up to four right-hand sides of large ones.
#include "base/symmetric_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.h"

namespace palpate {
namespace {

// How the squared error of one solution falls. The squared error at an iteration is the sum of all
// later decreases, of which the next ones are known some iterations later.
class Decrease {
 public:
  void add(double decrease) { sums_.push_back(sums_.back() + decrease); }
  // The squared error as it was a window ago, and a bound of the present one; negative at first.
  [[nodiscard]] double before_window() const {
    const std::size_t now = sums_.size() - 1;
    const std::size_t window = 10 + now / 4;  // long enough where convergence halts for a while
    return now < window ? -1.0 : sums_[now] - sums_[now - window];
  }

 private:
  std::vector<double> sums_{0.0};
};

}  // namespace

bool SymmetricSolver::prepare(BlockMatrix matrix, std::vector<char> held) {
  matrix_ = std::move(matrix);
  held_ = std::move(held);
  error_ = 0.0;
  factors_.reset();
  if (static_cast<Eigen::Index>(held_.size()) < large) {
    factors_.emplace();
    return factors_->factor(matrix_.split(held_));
  }
  const Vector diagonal = matrix_.diagonal();
  inverse_diagonal_.setZero(static_cast<Eigen::Index>(held_.size()));
  for (Eigen::Index d = 0; d < diagonal.size(); ++d) {
    if (held_[as_index(d)] != 0) continue;
    if (!(diagonal[d] > 0.0) || !std::isfinite(diagonal[d])) return false;
    inverse_diagonal_[d] = 1.0 / diagonal[d];
  }
  coarse_.emplace();
  return coarse_->prepare(matrix_, held_);
}

bool SymmetricSolver::solve(std::span<const Vector> b, std::span<Vector> x) {
  if (!factors_) {
    for (std::size_t first = 0; first < b.size(); first += block_lanes) {
      const std::size_t count = std::min(block_lanes, b.size() - first);
      if (!iterate(b.subspan(first, count), x.subspan(first, count))) return false;
    }
    return true;
  }
  for (std::size_t k = 0; k < b.size(); ++k) precondition(b[k], x[k]);
  return true;
}

void SymmetricSolver::precondition(const Vector& r, Vector& z) {
  if (!factors_) {
    z = inverse_diagonal_.cwiseProduct(r);
    return coarse_->add(r, 1, 1, z);
  }
  unheld_ = r;
  for (std::size_t d = 0; d < held_.size(); ++d)
    if (held_[d] != 0) unheld_[static_cast<Eigen::Index>(d)] = 0.0;
  factors_->solve(unheld_, z);
}

bool SymmetricSolver::iterate(std::span<const Vector> b, std::span<Vector> x) {
  constexpr auto lanes = static_cast<Eigen::Index>(block_lanes);
  const auto size = static_cast<Eigen::Index>(held_.size());
  using Columns = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, lanes, Eigen::RowMajor>>;
  vectors_.right.setZero(lanes * size);
  vectors_.x.setZero(lanes * size);
  for (std::size_t l = 0; l < b.size(); ++l) {
    const auto lane = static_cast<Eigen::Index>(l);
    for (Eigen::Index d = 0; d < size; ++d) {
      if (held_[as_index(d)] != 0) continue;
      vectors_.right[lanes * d + lane] = b[l][d];
      if (x[l].size() == size) vectors_.x[lanes * d + lane] = x[l][d];
    }
  }
  std::array<Decrease, block_lanes> decreases;
  // Where a degree of freedom is held, `inverse_diagonal_` is 0, so that its direction stays 0.
  // Rounding keeps conjugate gradients from ending after as many iterations as there are unknowns.
  const bool solved = conjugate_gradients<block_lanes>(
      vectors_, tolerance_, as_index(10 * size),
      [&](const Vector& from, Vector& to) { matrix_.multiply_lanes(from, to); },
      [&](const Vector& r, Vector& z) {
        z.resize(r.size());
        for (Eigen::Index d = 0; d < size; ++d)
          z.segment<lanes>(lanes * d) = inverse_diagonal_[d] * r.segment<lanes>(lanes * d);
        coarse_->add(r, b.size(), block_lanes, z);
      },
      [&](std::size_t lane, double decrease, double) {
        decreases[lane].add(decrease);
        return decreases[lane].before_window();
      },
      error_);
  if (!solved) return false;
  for (std::size_t l = 0; l < b.size(); ++l)
    x[l] = Columns(vectors_.x.data(), size, lanes).col(static_cast<Eigen::Index>(l));
  return true;
}

}  // namespace palpate
