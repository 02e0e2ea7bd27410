// Steps in increments w = u(t+dt) - u(t), which keeps small motions exact.
#include "integrate/central_difference.h"

namespace palpate::integrate {
namespace {

void clear_held(std::span<const char> held, Vector& vector) {
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) vector[static_cast<Eigen::Index>(d)] = 0.0;
}

}  // namespace

CentralDifference::CentralDifference(const Body& body, double time_step, Start start)
    : body_(&body), time_step_(time_step), start_(start) {
  diagonal_ = 2.0 * body.mass() + time_step * body.drag();
}

void CentralDifference::factor(const Vector& displacement) {
  dashpots_ = body_->dashpots(displacement);
  SplitMatrix left = dashpots_;
  left *= time_step_;
  left.local.diagonal() += diagonal_;
  // A sum of positive masses and non-negative dashpots: always positive definite.
  [[maybe_unused]] const bool factored = factors_.factor(left);
  eigen_assert(factored || !displacement.allFinite());
  has_factors_ = true;
}

void CentralDifference::step(State& state, const Vector& load) {
  // (2 M + D dt) w = 2 dt^2 (F - f(u)) + (2 M - D dt) (u - u_before)   Chen 2007 eq. (12) in
  // increments; the consistent first one is dt^2 (F - f) + 2 M dt v   docs/theory.md (38), (39)
  const bool consistent = first_ && start_ == Start::consistent;
  if (first_) before_ = time_step_ * state.velocity;
  if (first_ && start_ == Start::paper) before_.setZero();
  first_ = false;
  const double square = (consistent ? 1.0 : 2.0) * time_step_ * time_step_;
  body_->force(state.displacement, state.memory, force_);
  right_ = square * (load - force_);
  right_ += 2.0 * body_->mass().cwiseProduct(before_);
  if (!consistent) right_ -= time_step_ * body_->drag().cwiseProduct(before_);
  if (body_->has_dashpots()) {
    if (!has_factors_ || !body_->linear()) factor(state.displacement);
    if (!consistent) right_ -= time_step_ * (dashpots_ * before_);
  }
  clear_held(body_->held(), right_);
  before_ =
      body_->has_dashpots() ? factors_.solve(right_) : Vector(right_.cwiseQuotient(diagonal_));
  clear_held(body_->held(), before_);
  state.displacement += before_;
  state.velocity = before_ / time_step_;
  state.time += time_step_;
  body_->remember(state.displacement, {time_step_, MemoryRule::exact}, state.memory);
}

}  // namespace palpate::integrate
