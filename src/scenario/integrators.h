// What each integrator promises: in one place, for whoever plans steps, refuses, or tests.
#pragma once

#include <optional>

#include "scenario/scenario.h"

namespace palpate::scenario {

// Whether it is stable below a limit only.
[[nodiscard]] inline bool explicit_steps(Solver::Integrator integrator) {
  return integrator == Solver::Integrator::central_difference ||
         integrator == Solver::Integrator::semi_implicit_euler;
}

// The velocity that damping takes; of explicit steps.
[[nodiscard]] inline integrate::DampingVelocity damping_velocity(const Solver& solver) {
  return solver.integrator == Solver::Integrator::semi_implicit_euler
             ? integrate::DampingVelocity::ahead
             : solver.damping;
}

// The power of the step that the error of the displacement falls with, while loads are constant or
// smooth; nothing where those that go evenly leave none.
[[nodiscard]] inline std::optional<int> order_in_time(const Solver& solver,
                                                      tissue::Viscosity viscosity) {
  using Integrator = Solver::Integrator;
  const bool damped =
      viscosity == tissue::Viscosity::nodal_drag || viscosity == tissue::Viscosity::kelvin_voigt;
  switch (solver.integrator) {
    case Integrator::automatic:  // central differences, or no inertia
    case Integrator::central_difference: {
      const bool lags = damped && solver.damping == integrate::DampingVelocity::lagged;
      return lags || solver.start == integrate::Start::paper ? 1 : 2;
    }
    case Integrator::semi_implicit_euler: return 1;
    case Integrator::backward_difference: return 1;
    case Integrator::tr_bdf2: return 2;
    case Integrator::quasi_static: return 2;
    case Integrator::modal: break;
  }
  return std::nullopt;
}

}  // namespace palpate::scenario
