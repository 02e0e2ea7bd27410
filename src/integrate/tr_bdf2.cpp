// Computes both stages as implicit Euler steps.
#include "integrate/tr_bdf2.h"

namespace palpate::integrate {

// past_ = the state advanced by `time` (s) with explicit Euler. An implicit Euler step of the same
// length from there gives the trapezoidal rule.
void TrBdf2::extrapolate(const State& state, double time) {
  Vector& acceleration = acceleration_;
  past_ = state;
  if (past_.force.size() == 0) body_->look(past_);
  acceleration = load_ - past_.force - body_->drag().cwiseProduct(state.velocity);
  if (body_->has_dashpots()) {
    body_->dashpot_force(state.displacement, state.velocity, force_);
    acceleration -= force_;
  }
  acceleration = acceleration.cwiseQuotient(body_->mass());
  const auto held = body_->held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) acceleration[static_cast<Eigen::Index>(d)] = 0.0;
  past_.displacement += time * state.velocity;
  past_.velocity += time * acceleration;
  if (!body_->has_dashpots()) {
    body_->remember(state.displacement, {time, MemoryRule::forward}, past_.memory);
    return;
  }
  // Elongations are extrapolated as e + time e'. Those of springs that rotate contain terms of
  // second order in time, which the central difference of the elongations ahead and behind removes.
  const std::vector<double>& ahead = memory_ahead_;
  const std::vector<double>& behind = memory_behind_;
  behind_ = state.displacement - time * state.velocity;
  body_->memory_at(past_.displacement, memory_ahead_);
  body_->memory_at(behind_, memory_behind_);
  for (std::size_t i = 0; i < past_.memory.size(); ++i)
    past_.memory[i] = state.memory[i] + 0.5 * (ahead[i] - behind[i]);
}

void TrBdf2::begin(const State& state, double time_step, MemoryRule) {
  time_step_ = time_step;
  const double euler_step = 0.5 * first_part * time_step;
  if (!second_) {
    start_ = state;
    if (load_.size() == 0) load_ = Vector::Zero(state.displacement.size());
    extrapolate(state, euler_step);
  } else {
    // u1 - a u_gamma + (a - 1) u0 = (1 - gamma) / (2 - gamma) dt u1',  a = 1 / (gamma (2 - gamma));
    // for this gamma, (1 - gamma) / (2 - gamma) = gamma / 2.
    constexpr double a = 1.0 / (first_part * (2.0 - first_part));
    past_ = state;
    past_.displacement = a * state.displacement - (a - 1.0) * start_.displacement;
    past_.velocity = a * state.velocity - (a - 1.0) * start_.velocity;
    for (std::size_t i = 0; i < past_.memory.size(); ++i)
      past_.memory[i] = a * state.memory[i] - (a - 1.0) * start_.memory[i];
  }
  euler_.begin(past_, euler_step, MemoryRule::first_order);
}

void TrBdf2::finish(State& state, const Vector& displacement, const Vector& load) {
  euler_.finish(past_, displacement, load);
  state = past_;
  state.time = start_.time + (second_ ? 1.0 : first_part) * time_step_;
  second_ = !second_;
}

}  // namespace palpate::integrate
