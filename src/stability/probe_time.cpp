// Probes for failures of time steps: divergence, overflow, drift of energy.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mechanics/stepper.h"
#include "stability/survey.h"

namespace palpate::stability {
namespace {

using scenario::Solver;

std::string rung_word(const Survey& survey) { return scenario::rung(survey.rung.model).word; }

// Growth of the amplitude per step at 0.95 and 1.05 of the limit, undamped.
void probe_divergence(Survey& survey) {
  ProbedBody& own = *survey.own;
  own.scene.scenario.solver.integrator = Solver::Integrator::central_difference;
  const FreeMotion motion{
      .scene = &own.scene, .body = own.elastic.get(), .mode = own.highest, .steps = 4000};
  const double limit = 2.0 / own.highest.frequency;
  for (const double share : {0.95, 1.05}) {
    survey.go_on("divergence");
    FailureRow row;
    row.failure = Failure::divergence;
    row.rung = rung_word(survey);
    row.integrator = "central_difference";
    row.setting = share;
    row.setting_unit = "time step over 2/omega_max";
    row.measure = "growth of the amplitude in a step";
    const Moved early = move(motion, share * limit, 1e8);
    row.reached = early.ending == Ending::grows;
    if (row.reached) {
      const Moved late = move(motion, share * limit, 1e40);
      row.measured =
          std::exp(0.5 * std::log(late.after / early.after) / (late.steps - early.steps));
      row.theory = growth_beyond(2.0 * share);
    } else {
      row.measured = std::pow(early.after / early.before, 1.0 / motion.steps);
      row.theory = 1.0;
    }
    survey.map.failures.push_back(std::move(row));
  }
}

// Number of steps at twice the limit until the energy is not finite.
void probe_overflow(Survey& survey) {
  survey.go_on("overflow");
  ProbedBody& own = *survey.own;
  own.scene.scenario.solver.integrator = Solver::Integrator::central_difference;
  const FreeMotion motion{
      .scene = &own.scene, .body = own.elastic.get(), .mode = own.highest, .steps = 4000};
  const double step = 4.0 / own.highest.frequency;
  const Moved early = move(motion, step, 1e8);
  const Moved late = move(motion, step, std::numeric_limits<double>::infinity());
  FailureRow row;
  row.failure = Failure::non_finite;
  row.rung = rung_word(survey);
  row.integrator = "central_difference";
  row.setting = 2.0;
  row.setting_unit = "time step over 2/omega_max";
  row.measure = "steps until energy is no number";
  row.reached = late.ending == Ending::not_finite;
  row.measured = late.steps;
  // E_n = E_1 s^(2 (n - 1)) exceeds the largest double.
  const double room = std::log(std::numeric_limits<double>::max()) - std::log(early.after);
  row.theory = early.steps + std::ceil(0.5 * room / std::log(growth_beyond(4.0)));
  survey.map.failures.push_back(std::move(row));
}

// The factor by which one step changes the amplitude of a body released in its lowest mode.
double amplitude_kept(const Survey& survey, const BodyMode& lowest, double time_step, int steps) {
  const scene::SpringBody& body = *survey.own->elastic;
  mechanics::Stepper stepper(survey.own->scene, body);
  stepper.set_step(time_step);
  integrate::State state;
  state.displacement = 1e-6 / lowest.shape.cwiseAbs().maxCoeff() * lowest.shape;
  state.velocity = integrate::Vector::Zero(state.displacement.size());
  state.memory = body.memory_at(state.displacement);
  const integrate::Vector nothing = state.velocity;
  std::array<double, 4> greatest{};
  for (int i = 0; i < steps; ++i) {
    if (stepper.step(state, nothing, nothing, integrate::MemoryRule::exact))
      return std::numeric_limits<double>::quiet_NaN();
    double& most = greatest[as_index(4 * i / steps)];
    most = std::max(most, body.stored(state) + body.kinetic(state));
  }
  // From the first quarter to the last one.
  return std::pow(greatest[3] / greatest[0], 0.5 / (0.75 * steps));
}

void probe_drift(Survey& survey) {
  ProbedBody& own = *survey.own;
  const BodyMode lowest = lowest_mode(*own.elastic);
  const double explicit_step = 0.9 * 2.0 / own.highest.frequency;
  for (const Method& method : methods()) {
    // Statics have no amplitude; `modal` propagates modes exactly, from rest.
    if (!about(method.integrator).inertia || method.integrator == Integrator::modal || method.lags)
      continue;
    survey.go_on("drift");
    const bool limited = method.explicit_steps();
    const double step = limited ? explicit_step : survey.one->scenario.output.interval;
    own.scene.scenario.solver.integrator = method.integrator;
    FailureRow row;
    row.failure = Failure::drift;
    row.rung = rung_word(survey);
    row.integrator = method.name();
    row.setting = 1e6 * step;
    row.setting_unit = "us, the time step";
    row.measure = "amplitude of the lowest mode after an undamped step over before";
    row.measured = amplitude_kept(survey, lowest, step, limited ? 4000 : 40);
    row.theory = amplification(method.integrator, lowest.frequency * step);
    // 1e-6 per step is a thousandth of the amplitude in a thousand steps.
    row.reached = !(std::abs(*row.measured - 1.0) < 1e-6);
    survey.map.failures.push_back(std::move(row));
  }
}

}  // namespace

void probe_time(Survey& survey) {
  for (const auto& probe : {probe_divergence, probe_overflow, probe_drift}) probe(survey);
}

}  // namespace palpate::stability
