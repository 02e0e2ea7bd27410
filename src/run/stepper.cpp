// Which method the scenario names, and how it is driven.
#include "run/stepper.h"

namespace palpate::run {
namespace {

Stepper::Method make_method(const scene::Scene& scene, const scene::SpringBody& body,
                            double time_step) {
  using Integrator = scenario::Solver::Integrator;
  using Inertia = integrate::Implicit::Inertia;
  switch (scene.scenario.solver.integrator) {
    case Integrator::automatic:  // has been answered when a scene is built
    case Integrator::central_difference:
      return integrate::CentralDifference(body, time_step, scene.scenario.solver.start);
    case Integrator::backward_difference:
      return integrate::Implicit(body, Inertia::backward_difference);
    case Integrator::quasi_static: return integrate::Implicit(body, Inertia::none);
    case Integrator::modal: break;
  }
  return integrate::Modal(body);
}

}  // namespace

void Stepper::set_step(double time_step) {
  const bool fixed_step = method_ && std::holds_alternative<integrate::CentralDifference>(*method_);
  if (!method_ || (fixed_step && time_step != time_step_)) {
    method_.emplace(make_method(*scene_, *body_, time_step));
    ++beginnings_;
  }
  time_step_ = time_step;
}

void Stepper::restart() {
  if (!method_) return;
  if (auto* central = std::get_if<integrate::CentralDifference>(&*method_)) central->restart();
  ++beginnings_;
}

std::optional<std::string> Stepper::step(integrate::State& state,
                                         const integrate::Vector& load_before,
                                         const integrate::Vector& load_after,
                                         integrate::MemoryRule rule) {
  if (auto* central = std::get_if<integrate::CentralDifference>(&*method_)) {
    central->step(state, load_before);
    return std::nullopt;
  }
  if (auto* implicit = std::get_if<integrate::Implicit>(&*method_))
    return solve_step(*implicit, *body_, state, time_step_, rule, load_after);
  return solve_step(std::get<integrate::Modal>(*method_), *body_, state, time_step_, rule,
                    load_after);
}

}  // namespace palpate::run
