// Steps in increments w = u(t+dt) - u(t), which keeps small motions accurate.
#include "integrate/central_difference.h"

#include <cmath>
#include <limits>

#include "base/index.h"
#include "tissue/fast_vectors.h"

namespace palpate::integrate {
namespace {

void clear_held(std::span<const char> held, Vector& vector) {
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) vector[static_cast<Eigen::Index>(d)] = 0.0;
}

}  // namespace

double explicit_limit(DampingVelocity velocity, const FastestMode& mode) {
  double linear = mode.forces;
  if (velocity == DampingVelocity::lagged) linear += 2.0 * mode.rate;
  if (velocity == DampingVelocity::ahead) linear -= 2.0 * mode.rate;
  return (std::sqrt(linear * linear + 16.0 * mode.squared) - linear) / (2.0 * mode.squared);
}

CentralDifference::CentralDifference(const Body& body, double time_step, Start start,
                                     DampingVelocity velocity)
    : body_(&body), time_step_(time_step), start_(start), velocity_(velocity) {
  using enum DampingVelocity;
  left_rate_ = velocity == ahead ? 2.0 * time_step : velocity == lagged ? 0.0 : time_step;
  right_rate_ = 2.0 * time_step - left_rate_;
  const Vector twice = 2.0 * body.mass();
  keep_ = twice - right_rate_ * body.drag();
  // (39): the damping of the start velocity is in the matrix on the left, unless it is lagged.
  keep_first_ = velocity == lagged ? Vector(twice - time_step * body.drag()) : twice;
  diagonal_ = twice + left_rate_ * body.drag();
  inverse_ = diagonal_.cwiseInverse();
  clear_held(body.held(), inverse_);
}

void CentralDifference::factor(const Vector& displacement) {
  SplitMatrix left = body_->dashpots(displacement);
  left *= left_rate_;
  left.local.diagonal() += diagonal_;
  // Positive masses plus non-negative dashpots are always positive definite.
  [[maybe_unused]] const bool factored = factors_.factor(left);
  eigen_assert(factored || !displacement.allFinite());
  has_factors_ = true;
}

// Solves (2 M + dt D) w = right_ - lag D w_before if dashpots join nodes; before_ becomes w.
void CentralDifference::solve_dashpots(const State& state, double lag) {
  if (lag > 0.0) {
    body_->dashpot_force(state.displacement, before_, image_);
    right_ -= lag * image_;
  }
  if (left_rate_ == 0.0) {
    before_ = inverse_.cwiseProduct(right_);
    return;
  }
  constexpr Eigen::Index too_large_to_factor = 9000;
  const bool large = right_.size() >= too_large_to_factor;
  if (!has_factors_ && !large) factor(state.displacement);
  clear_held(body_->held(), right_);
  if (body_->linear() && !large)
    factors_.solve(right_, before_);
  else
    solve_turned(state.displacement, large);
  clear_held(body_->held(), before_);
}

// For dashpots that have rotated since they were factored: conjugate gradients, preconditioned by
// the old factors and started from a straight line through the previous steps. They stop at an
// error in the energy norm of |w - w_exact|_A <= 1e-10 |w|_A. Large bodies have no factors, but the
// diagonal with groups of nodes, and a tolerance that is still far below the step's own error.
void CentralDifference::solve_turned(const Vector& displacement, bool large) {
  const double tolerance = large ? 1e-5 : 1e-10;
  constexpr int worth_factoring = 12;
  const int most = large ? 10000 : 200;
  const auto precondition = [&] {
    if (large)
      precondition_large(displacement);
    else
      factors_.solve(residual_, refined_);
  };
  const auto count = as_index(right_.size());
  const auto dot = [count](const Vector& a, const Vector& b) {
    return tissue::sum_of_products(count, a.data(), b.data());
  };
  const auto multiply = [&](const Vector& x) {
    body_->dashpot_force(displacement, x, image_);
    image_ = diagonal_.cwiseProduct(x) + left_rate_ * image_;
    clear_held(body_->held(), image_);
  };
  clear_held(body_->held(), before_);
  image_ = before_;
  if (earlier_.size() > 0) before_ = 2.0 * before_ - earlier_;
  earlier_.swap(image_);
  multiply(before_);
  residual_ = right_ - image_;
  precondition();
  direction_ = refined_;
  double size = dot(residual_, refined_);
  int i = 0;
  while (size > tolerance * tolerance * std::abs(dot(before_, right_)) && i < most) {
    multiply(direction_);
    const double length = size / dot(direction_, image_);
    before_ += length * direction_;
    residual_ -= length * image_;
    precondition();
    const double next = dot(residual_, refined_);
    direction_ = refined_ + (next / size) * direction_;
    size = next;
    ++i;
  }
  // Without convergence there is no result: NaN ends the run as diverged.
  if (i == most) before_.setConstant(std::numeric_limits<double>::quiet_NaN());
  has_factors_ = has_factors_ && i <= worth_factoring;
}

void CentralDifference::precondition_large(const Vector& displacement) {
  if (large_inverse_.size() == 0) {
    BlockMatrix left = body_->dashpot_blocks(displacement);
    for (BlockMatrix::Block& block : left.blocks) block *= left_rate_;
    for (double& weight : left.weights) weight *= left_rate_;
    for (int n = 0; n < left.nodes(); ++n) left.at(n, n).diagonal() += diagonal_.segment<3>(3 * n);
    large_inverse_ = left.diagonal().cwiseInverse();
    clear_held(body_->held(), large_inverse_);
    // Positive masses plus non-negative dashpots are always positive definite.
    [[maybe_unused]] const bool prepared = smooth_.prepare(left, body_->held());
    eigen_assert(prepared || !displacement.allFinite());
  }
  refined_ = large_inverse_.cwiseProduct(residual_);
  smooth_.add({residual_.data(), as_index(residual_.size())}, 1, 1,
              {refined_.data(), as_index(refined_.size())});
}

void CentralDifference::step(State& state, const Vector& load) {
  // (2 M + D dt) w = 2 dt^2 (F - f(u)) + (2 M - D dt) (u - u_before)   Chen 2007 eq. (12) in
  // increments; the consistent first one is dt^2 (F - f) + 2 M dt v   docs/theory.md (38), (39)
  // With `ahead` the velocity of the state is that of the previous step, also in a first step.
  const bool begins = first_ && velocity_ != DampingVelocity::ahead;
  const bool consistent = begins && start_ == Start::consistent;
  if (first_) before_ = time_step_ * state.velocity;
  if (begins && start_ == Start::paper) before_.setZero();
  first_ = false;
  const double square = (consistent ? 1.0 : 2.0) * time_step_ * time_step_;
  const double rate = 1.0 / time_step_;
  body_->force(state.displacement, state.memory, force_);
  const Vector& keep = consistent ? keep_first_ : keep_;
  if (body_->has_dashpots()) {
    right_ = square * (load - force_) + keep.cwiseProduct(before_);
    // In a consistent first step the lagged D counts half, and the centred D is on the left alone.
    const bool lags = velocity_ == DampingVelocity::lagged;
    solve_dashpots(state, consistent ? (lags ? time_step_ : 0.0) : right_rate_);
    state.displacement += before_;
    state.velocity = rate * before_;
  } else {
    // Multiplies by the inverse, because a division costs as much as the rest of the line.
    tissue::advance(as_index(before_.size()), {.square = square,
                                               .rate = rate,
                                               .inverse = inverse_.data(),
                                               .keep = keep.data(),
                                               .external = load.data(),
                                               .internal = force_.data(),
                                               .moved = before_.data(),
                                               .displacement = state.displacement.data(),
                                               .velocity = state.velocity.data()});
  }
  state.time += time_step_;
  body_->remember(state.displacement, {time_step_, MemoryRule::exact}, state.memory);
}

}  // namespace palpate::integrate
