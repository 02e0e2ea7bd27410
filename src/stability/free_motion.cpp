// A body is loaded in the first step and then moves freely while its energy is recorded.
#include "stability/free_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numerics.h"
#include "mechanics/stepper.h"

namespace palpate::stability {

using integrate::Vector;

void LaggedDifference::step(integrate::State& state, const Vector& load) {
  const double dt = time_step_;
  if (state.force.size() == 0) body_->look(state);
  damping_ = body_->drag().cwiseProduct(state.velocity);
  if (body_->has_dashpots()) {
    body_->dashpot_force(state.displacement, state.velocity, dashpots_);
    damping_ += dashpots_;
  }
  state.velocity += dt * (load - state.force - damping_).cwiseQuotient(body_->mass());
  const auto held = body_->held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) state.velocity[static_cast<Eigen::Index>(d)] = 0.0;
  state.displacement += dt * state.velocity;
  state.time += dt;
  body_->arrive(state, {dt, integrate::MemoryRule::exact});
}

Moved move(const FreeMotion& motion, double time_step, double enough) {
  const scene::SpringBody& body = *motion.body;
  integrate::State state;
  state.displacement = Vector::Zero(body.mass().size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);

  // The stroke moves an undamped body by about a micrometre in the first step.
  Vector rest = scattered(body);
  rest *= 0.3 / std::sqrt(rest.dot(body.mass().cwiseProduct(rest)));
  Vector shape = motion.mode.shape + rest;
  shape *= 1e-6 / shape.cwiseAbs().maxCoeff();
  const Vector stroke = body.mass().cwiseProduct(shape) / (time_step * time_step);
  const Vector nothing = Vector::Zero(shape.size());

  LaggedDifference by_lag(body, time_step);
  mechanics::Stepper stepper(*motion.scene, body);
  if (!motion.lagged) stepper.set_step(time_step);

  Moved moved;
  std::array<double, 4> greatest{};
  double first = 0.0;
  Vector load = stroke;
  Vector load_after = stroke;
  for (int i = 0; i < motion.steps; ++i) {
    if (i > 0) load = nothing;
    if (motion.contact != nullptr)
      load -= motion.contact->stiffness * motion.contact->weights.dot(state.displacement) *
              motion.contact->weights;
    load_after = i == 0 ? stroke : nothing;
    if (motion.lagged) {
      by_lag.step(state, load);
    } else if (stepper.step(state, load, load_after, integrate::MemoryRule::exact)) {
      moved.ending =
          std::isfinite(state.displacement.sum()) ? Ending::cannot_step : Ending::not_finite;
      return moved;
    }
    double energy = body.stored(state) + body.kinetic(state);
    if (motion.contact != nullptr) {
      const double sunk = motion.contact->weights.dot(state.displacement);
      energy += 0.5 * motion.contact->stiffness * sunk * sunk;
    }
    moved.steps = i + 1;
    moved.after = energy;
    if (!std::isfinite(energy)) {
      moved.ending = Ending::not_finite;
      return moved;
    }
    if (i == 0) first = energy;
    if (energy > enough * first) {
      moved.ending = Ending::grows;
      return moved;
    }
    double& most = greatest[as_index(4 * i / motion.steps)];
    most = std::max(most, energy);
  }
  moved.before = greatest[1];
  moved.after = greatest[3];
  // The energy of a motion that has decayed to rounding errors is not compared.
  const bool dead = moved.after <= 1e-24 * std::max(first, greatest[0]);
  if (!dead && moved.after > motion.growth * moved.before) moved.ending = Ending::grows;
  return moved;
}

void choose_length(FreeMotion& motion, double damping_ratio) {
  // For a time step that is e (relative) above the limit, one root is -1 - d: over half of n steps
  // the energy grows by exp(n d). Undamped, d = sqrt(8 e), and e = 0.0005 gives a factor of 1e11 in
  // 400 steps. With heavy centred damping, d is about 2 e / zeta: n = 10 zeta gives exp(20 e), 1.05
  // at e = 0.0025. With damping that lags or leads, d = 2 e for every zeta.
  constexpr double most = 40000.0;
  motion.steps = 400;
  if (!motion.lagged && motion.centred)
    motion.steps = static_cast<int>(std::min(400.0 + 10.0 * damping_ratio, most));
  motion.growth = damping_ratio > 0.05 ? 1.05 : 2.0;
}

std::optional<double> bisect_limit(const std::function<bool(double)>& stable, double start,
                                   double most, double resolution) {
  double low = start;
  double high = start;
  if (stable(start)) {
    do {
      low = high;
      high *= 2.0;
      if (high > most) return std::nullopt;
    } while (stable(high));
  } else {
    do {
      high = low;
      low *= 0.5;
      if (low < 1e-9 * start) return 0.0;
    } while (!stable(low));
  }
  return numerics::change({low, high}, resolution, stable).middle();
}

}  // namespace palpate::stability
