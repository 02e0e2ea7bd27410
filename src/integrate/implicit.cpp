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
    // M / dt^2 + D / dt + K                              docs/theory.md (40)
    if (moving) matrix.local.diagonal() += body_->mass() / (dt * dt) + body_->drag() / dt;
    if (!factors_.factor(matrix)) return false;
    factored_ = step_;
    has_factors_ = true;
  }
  body_->step_force(displacement, state_->memory, step_, force_);
  Vector residual = load - force_;
  if (moving) {
    const Vector moved = displacement - state_->displacement;
    residual -= body_->mass().cwiseProduct(moved - dt * state_->velocity) / (dt * dt) +
                body_->drag().cwiseProduct(moved) / dt;
  }
  base_ = displacement + response(residual);
  return true;
}

Vector Implicit::response(const Vector& load) const {
  Vector right = load;
  const auto held = body_->held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) right[static_cast<Eigen::Index>(d)] = 0.0;
  return factors_.solve(right);
}

void Implicit::finish(State& state, const Vector& displacement, const Vector&) {
  body_->remember(displacement, step_, state.memory);
  // Without inertia a velocity has no meaning, and no energy.
  if (inertia_ == Inertia::backward_difference && step_.size > 0.0)
    state.velocity = (displacement - state.displacement) / step_.size;
  state.displacement = displacement;
  state.time += step_.size;
}

}  // namespace palpate::integrate
