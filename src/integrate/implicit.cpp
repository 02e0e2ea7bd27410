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
  clear_held(body_->held(), moved);
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
  clear_held(body_->held(), acceleration);
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

void EquivalentLoad::set_step(double time_step) {
  steps_.clear();
  const auto add = [&](double time) {
    steps_.push_back(rule_ == MemoryRule::first_order
                         ? tissue::MemoryStep::first_order(time_step, time)
                         : tissue::MemoryStep::exact(time_step, time));
  };
  if (law_.kind == tissue::Viscosity::kelvin_voigt) add(law_.time);
  for (const tissue::Branch& branch : law_.branches) add(branch.time);
}

void EquivalentLoad::pass(const Vector& load) {
  if (steps_.empty()) {
    load_ = load;
    return;
  }
  if (load_.size() == 0) {
    load_ = Vector::Zero(load.size());
    memory_.assign(steps_.size(), load_);
  }
  if (law_.branches.empty()) {
    // tau J' + J = L; the memory is the load before.                   docs/theory.md [memory]
    const tissue::MemoryStep& step = steps_.front();
    load_ = step.keep * load_ + step.begin * memory_.front() + step.end * load;
    memory_.front() = load;
    return;
  }
  // L_1 = J_1 + sum b (J_1 - q_1),  q_1 = keep q_0 + begin J_0 + end J_1  docs/theory.md [branches]
  double stiffness = 1.0;
  right_ = load;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double ratio = law_.branches[k].ratio;
    stiffness += ratio * (1.0 - steps_[k].end);
    memory_[k] = steps_[k].keep * memory_[k] + steps_[k].begin * load_;
    right_ += ratio * memory_[k];
  }
  load_ = right_ / stiffness;
  for (std::size_t k = 0; k < steps_.size(); ++k) memory_[k] += steps_[k].end * load_;
}

void EquivalentLoad::renumber(const std::vector<Eigen::Index>& from) {
  const auto turn = [&](Vector& vector) {
    if (vector.size() == 0) return;
    const Vector old = vector;
    vector.resize(static_cast<Eigen::Index>(from.size()));
    for (std::size_t d = 0; d < from.size(); ++d)
      vector[static_cast<Eigen::Index>(d)] = from[d] < 0 ? 0.0 : old[from[d]];
  };
  turn(load_);
  for (Vector& one : memory_) turn(one);
}

}  // namespace palpate::integrate
