// Steps in increments w = u(t+dt) - u(t), which keeps small motions accurate.
#include "integrate/central_difference.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/index.h"
#include "integrate/wide_loops.h"

namespace palpate::integrate {
namespace {

// Relative error of solutions with dashpots, in the energy norm: far below that of a step.
constexpr double tolerance = 1e-10;

}  // namespace

double explicit_limit(DampingVelocity velocity, const FastestMode& mode) {
  double linear = mode.forces;
  if (velocity == DampingVelocity::lagged) linear += 2.0 * mode.rate;
  if (velocity == DampingVelocity::ahead) linear -= 2.0 * mode.rate;
  return (std::sqrt(linear * linear + 16.0 * mode.squared) - linear) / (2.0 * mode.squared);
}

CentralDifference::CentralDifference(const Body& body, double time_step, Start start,
                                     DampingVelocity velocity)
    : body_(&body), time_step_(time_step), start_(start), velocity_(velocity), solver_(tolerance) {
  using enum DampingVelocity;
  left_rate_ = velocity == ahead ? 2.0 * time_step : velocity == lagged ? 0.0 : time_step;
  right_rate_ = 2.0 * time_step - left_rate_;
  const Vector twice = 2.0 * body.mass();
  keep_ = twice - right_rate_ * body.drag();
  // [first_step]: the start velocity's damping is in the matrix on the left, unless it is lagged.
  keep_first_ = velocity == lagged ? Vector(twice - time_step * body.drag()) : twice;
  diagonal_ = twice + left_rate_ * body.drag();
  inverse_ = diagonal_.cwiseInverse();
  clear_held(body.held(), inverse_);
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
  if (!prepared_) {
    BlockMatrix left = body_->dashpots(state.displacement);
    left *= left_rate_;
    left.add_to_diagonal(diagonal_);
    // Positive masses plus non-negative dashpots are always positive definite.
    [[maybe_unused]] const bool positive =
        solver_.prepare(std::move(left), {body_->held().begin(), body_->held().end()});
    eigen_assert(positive || !state.displacement.allFinite());
    prepared_ = true;
  }
  clear_held(body_->held(), right_);
  if (!body_->linear()) return solve_turned(state.displacement);
  if (!solver_.solve(right_, before_))
    before_.setConstant(std::numeric_limits<double>::quiet_NaN());
}

// For dashpots that have rotated since the solver was prepared: conjugate gradients started from a
// straight line through the previous steps.
void CentralDifference::solve_turned(const Vector& displacement) {
  constexpr std::size_t worth_preparing = 12;
  constexpr std::size_t most = 10000;
  clear_held(body_->held(), before_);
  vectors_.right = right_;
  vectors_.x = before_;
  if (earlier_.size() > 0) vectors_.x += before_ - earlier_;
  earlier_ = before_;
  std::size_t iterations = 0;
  double error = 0.0;
  const bool solved = conjugate_gradients<1>(
      vectors_, tolerance, most,
      [&](const Vector& x, Vector& y) {
        body_->dashpot_force(displacement, x, image_);
        y = diagonal_.cwiseProduct(x) + left_rate_ * image_;
        clear_held(body_->held(), y);
      },
      [&](const Vector& r, Vector& z) { solver_.precondition(r, z); },
      [&](std::size_t, double, double next) {
        ++iterations;
        return next;  // the error, as far as the solver's matrix is still the present one
      },
      error);
  before_ = vectors_.x;
  // Without convergence there is no result: NaN ends the run as diverged.
  if (!solved) before_.setConstant(std::numeric_limits<double>::quiet_NaN());
  prepared_ = prepared_ && iterations <= worth_preparing;
}

void CentralDifference::step(State& state, const Vector& load) {
  // (2 M + D dt) w = 2 dt^2 (F - f(u)) + (2 M - D dt) (u - u_before)   Chen 2007 eq. (12) in
  // increments; the consistent first one is dt^2 (F - f) + 2 M dt v
  //                                                          docs/theory.md [central], [first_step]
  // With `ahead` the velocity of the state is that of the previous step, also in a first step.
  const bool begins = first_ && velocity_ != DampingVelocity::ahead;
  const bool consistent = begins && start_ == Start::consistent;
  if (first_) before_ = time_step_ * state.velocity;
  if (begins && start_ == Start::paper) before_.setZero();
  first_ = false;
  const double square = (consistent ? 1.0 : 2.0) * time_step_ * time_step_;
  const double rate = 1.0 / time_step_;
  if (state.force.size() == 0) body_->look(state);
  const Vector& keep = consistent ? keep_first_ : keep_;
  if (body_->has_dashpots()) {
    right_ = square * (load - state.force) + keep.cwiseProduct(before_);
    // In a consistent first step the lagged D counts half, and the centred D is on the left alone.
    const bool lags = velocity_ == DampingVelocity::lagged;
    solve_dashpots(state, consistent ? (lags ? time_step_ : 0.0) : right_rate_);
    state.displacement += before_;
    state.velocity = rate * before_;
  } else {
    // Multiplies by the inverse, because a division costs as much as the rest of the line.
    wide::advance(as_index(before_.size()), {.square = square,
                                             .rate = rate,
                                             .inverse = inverse_.data(),
                                             .keep = keep.data(),
                                             .external = load.data(),
                                             .internal = state.force.data(),
                                             .moved = before_.data(),
                                             .displacement = state.displacement.data(),
                                             .velocity = state.velocity.data()});
  }
  state.time += time_step_;
  body_->arrive(state, {time_step_, MemoryRule::exact});
}

}  // namespace palpate::integrate
