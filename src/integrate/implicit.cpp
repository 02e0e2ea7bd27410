// One Newton step: J du = F - M a - D v - f.
#include "integrate/implicit.h"

namespace palpate::integrate {

void Implicit::begin(const State& state, double time_step, MemoryRule rule) {
  state_ = &state;
  step_ = {time_step, inertia_ == Inertia::none ? rule : MemoryRule::first_order};
}

bool Implicit::linearise(const Vector& displacement, const Vector& load) {
  const double dt = step_.size;
  const bool moving = inertia_ == Inertia::backward_difference && dt > 0.0;
  if (!has_factors_ || !body_->linear() || !(factored_ == step_)) {
    SplitMatrix matrix = body_->step_stiffness(displacement, state_->memory, step_);
    // M / dt^2 + D / dt + K                        docs/theory.md [implicit]
    if (moving) matrix.local.diagonal() += body_->mass() / (dt * dt) + body_->drag() / dt;
    if (!factors_.factor(matrix)) return false;
    factored_ = step_;
    has_factors_ = true;
  }
  body_->step_force(displacement, state_->memory, step_, force_);
  residual_ = load - force_;
  if (moving) {
    moved_ = displacement - state_->displacement;
    residual_ -= body_->mass().cwiseProduct(moved_ - dt * state_->velocity) / (dt * dt) +
                 body_->drag().cwiseProduct(moved_) / dt;
  }
  response(residual_, moved_);
  base_ = displacement + moved_;
  return true;
}

Vector Implicit::response(const Vector& load) const {
  Vector moved;
  response(load, moved);
  return moved;
}

void Implicit::response(const Vector& load, Vector& moved) const {
  moved = load;
  const auto held = body_->held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) moved[static_cast<Eigen::Index>(d)] = 0.0;
  factors_.solve(moved, moved);
}

void Implicit::finish(State& state, const Vector& displacement, const Vector&) {
  // Without inertia the velocity has no meaning; it stays as it is.
  if (inertia_ == Inertia::backward_difference && step_.size > 0.0)
    state.velocity = (displacement - state.displacement) / step_.size;
  state.displacement = displacement;
  state.time += step_.size;
  body_->arrive(state, step_);
}

}  // namespace palpate::integrate
