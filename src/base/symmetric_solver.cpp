// Conjugate gradients for up to four right-hand sides in one pass over the matrix.
#include "base/symmetric_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/index.h"
#include "base/stop_scope.h"

namespace palpate {
namespace {

using Lanes = std::array<double, block_lanes>;

// Calls with(degree of freedom, lane, place in the vectors) for every number, in this order.
template <class With>
void for_each(std::size_t freedoms, const With& with) {
  for (std::size_t d = 0; d < freedoms; ++d)
    for (std::size_t l = 0; l < block_lanes; ++l) with(d, l, block_lanes * d + l);
}

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
  inverse_diagonal_.assign(held_.size(), 0.0);
  for (std::size_t d = 0; d < held_.size(); ++d) {
    if (held_[d] != 0) continue;
    const double own = diagonal[static_cast<Eigen::Index>(d)];
    if (!(own > 0.0) || !std::isfinite(own)) return false;
    inverse_diagonal_[d] = 1.0 / own;
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
  for (std::size_t k = 0; k < b.size(); ++k) {
    unheld_ = b[k];
    for (std::size_t d = 0; d < held_.size(); ++d)
      if (held_[d] != 0) unheld_[static_cast<Eigen::Index>(d)] = 0.0;
    factors_->solve(unheld_, x[k]);
  }
  return true;
}

bool SymmetricSolver::iterate(std::span<const Vector> b, std::span<Vector> x) {
  const std::size_t size = held_.size();
  right_.assign(block_lanes * size, 0.0);
  x_.assign(block_lanes * size, 0.0);
  for (std::size_t l = 0; l < b.size(); ++l) {
    const bool starts = x[l].size() == b[l].size();
    for (std::size_t d = 0; d < size; ++d) {
      if (held_[d] != 0) continue;
      right_[block_lanes * d + l] = b[l][static_cast<Eigen::Index>(d)];
      if (starts) x_[block_lanes * d + l] = x[l][static_cast<Eigen::Index>(d)];
    }
  }
  // Where a degree of freedom is held, `inverse_diagonal_` is 0, so that its direction stays 0.
  multiply_lanes(matrix_, x_, image_);
  r_.resize(right_.size());
  p_.resize(right_.size());
  for_each(size, [&](std::size_t d, std::size_t, std::size_t i) {
    r_[i] = right_[i] - image_[i];
    p_[i] = inverse_diagonal_[d] * r_[i];
  });
  coarse_->add(r_, b.size(), block_lanes, p_);
  Lanes rest{};  // r . z, where z is the preconditioned r
  for_each(size, [&](std::size_t, std::size_t l, std::size_t i) { rest[l] += r_[i] * p_[i]; });
  std::array<Decrease, block_lanes> decreases;
  std::array<bool, block_lanes> done{};
  for (std::size_t l = 0; l < block_lanes; ++l) done[l] = rest[l] == 0.0;
  // Rounding keeps conjugate gradients from ending after as many iterations as there are unknowns.
  const std::size_t most = 10 * size;
  for (std::size_t i = 0; !std::all_of(done.begin(), done.end(), std::identity{}); ++i) {
    if (i == most) return false;
    StopScope::end_if_stopped();
    multiply_lanes(matrix_, p_, image_);
    Lanes work{};
    for_each(size,
             [&](std::size_t, std::size_t l, std::size_t k) { work[l] += p_[k] * image_[k]; });
    Lanes length{};
    for (std::size_t l = 0; l < block_lanes; ++l) {
      if (done[l]) continue;
      if (!(work[l] > 0.0) || !std::isfinite(work[l])) return false;
      length[l] = rest[l] / work[l];
      decreases[l].add(length[l] * rest[l]);
    }
    Lanes next{};
    Lanes energy{};  // b . x, which is x A x at the solution
    for_each(size, [&](std::size_t d, std::size_t l, std::size_t k) {
      x_[k] += length[l] * p_[k];
      r_[k] -= length[l] * image_[k];
      image_[k] = inverse_diagonal_[d] * r_[k];
      energy[l] += right_[k] * x_[k];
    });
    coarse_->add(r_, b.size(), block_lanes, image_);
    for_each(size,
             [&](std::size_t, std::size_t l, std::size_t k) { next[l] += r_[k] * image_[k]; });
    Lanes turn{};
    for (std::size_t l = 0; l < block_lanes; ++l) {
      if (done[l]) continue;
      const double squared = decreases[l].before_window();
      done[l] = next[l] == 0.0 ||
                (squared >= 0.0 && squared <= tolerance_ * tolerance_ * std::abs(energy[l]));
      if (done[l] && squared > 0.0) error_ = std::max(error_, std::sqrt(squared / energy[l]));
      turn[l] = next[l] / rest[l];
    }
    for_each(size, [&](std::size_t, std::size_t l, std::size_t k) {
      p_[k] = image_[k] + turn[l] * p_[k];
    });
    rest = next;
  }
  for (std::size_t l = 0; l < b.size(); ++l) {
    x[l].resize(static_cast<Eigen::Index>(size));
    for (std::size_t d = 0; d < size; ++d)
      x[l][static_cast<Eigen::Index>(d)] = x_[block_lanes * d + l];
  }
  return true;
}

}  // namespace palpate
