// omega_max of the springs at their stiffest, and what follows for the step.
#include "scene/time_plan.h"

#include <algorithm>
#include <cmath>

#include "scene/scene.h"
#include "tissue/stable_step.h"

namespace palpate::scene {

TimePlan plan_time(const scenario::Scenario& scenario, const Specimen& specimen,
                   double contact_stiffness) {
  using Integrator = scenario::Solver::Integrator;
  const scenario::Solver& solver = scenario.solver;
  TimePlan plan;
  plan.time_step = solver.time_step.value_or(scenario.output.interval);
  std::vector<double> stiffest = specimen.network.stiffness;
  if (specimen.law.kind == tissue::Viscosity::standard_linear_solid)
    for (double& k : stiffest) k *= 1.0 + specimen.law.branch;
  plan.frequency_squared =
      tissue::largest_frequency_squared(specimen.network, stiffest, specimen.held) +
      contact_stiffness;
  plan.limit = 2.0 / std::sqrt(plan.frequency_squared);

  constexpr double safety = 0.9;
  double wanted = plan.time_step;
  if (solver.integrator == Integrator::central_difference) {
    wanted = safety * plan.limit;
  } else if (solver.integrator == Integrator::backward_difference && specimen.law.time > 0.0) {
    // Implicit Euler errs by about x/2 e^-1 at one viscous time, x = dt / tau.
    wanted = specimen.law.time / 50.0;
  }
  const double enough = std::max(1.0, std::ceil(plan.time_step / wanted));
  plan.substeps = solver.substeps.value_or(static_cast<int>(std::min(enough, 1e9)));
  plan.substep = plan.time_step / plan.substeps;
  return plan;
}

}  // namespace palpate::scene
