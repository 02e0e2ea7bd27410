// omega_max of the springs at their stiffest, and what follows for the step.
#include "scene/time_plan.h"

#include <algorithm>
#include <cmath>

#include "scene/scene.h"
#include "tissue/stable_step.h"

namespace palpate::scene {

TimePlan plan_time(const scenario::Scenario& scenario, const Specimen& specimen,
                   const ContactRate& contact) {
  using Integrator = scenario::Solver::Integrator;
  const scenario::Solver& solver = scenario.solver;
  TimePlan plan;
  plan.time_step = solver.time_step.value_or(scenario.output.interval);
  const double squared = specimen.law.instantaneous_ratio() *
                             tissue::largest_frequency_squared(specimen.network, specimen.held) +
                         contact.squared;
  // dt^2 omega^2 + dt C sum w^2 / m = 4: the dashpot's rate is that of the step before;
  // docs/theory.md (42), (76)
  const double damping = contact.damping;
  plan.limit = (std::sqrt(damping * damping + 16.0 * squared) - damping) / (2.0 * squared);
  plan.frequency_squared = 4.0 / (plan.limit * plan.limit);

  constexpr double safety = 0.9;
  double wanted = plan.time_step;
  if (solver.integrator == Integrator::central_difference) {
    wanted = safety * plan.limit;
  } else if (solver.integrator == Integrator::backward_difference &&
             specimen.law.shortest_time() > 0.0) {
    // Implicit Euler errs by about x/2 e^-1 at one viscous time, x = dt / tau.
    wanted = specimen.law.shortest_time() / 50.0;
  }
  const double enough = std::max(1.0, std::ceil(plan.time_step / wanted));
  plan.substeps = solver.substeps.value_or(static_cast<int>(std::min(enough, 1e9)));
  plan.substep = plan.time_step / plan.substeps;
  return plan;
}

bool inertia_reaches_force(const scenario::Scenario& scenario) {
  using tissue::Viscosity;
  if (scenario.uniform() || !scenario.meshed() ||
      scenario.contact.coupling != contact::Coupling::consistent ||
      scenario.solver.integrator == scenario::Solver::Integrator::quasi_static ||
      scenario.solver.kinematics != tissue::Kinematics::linear)
    return false;
  switch (scenario.tissue.viscosity) {
    case Viscosity::none:
    case Viscosity::nodal_drag: return true;
    case Viscosity::standard_linear_solid:
    case Viscosity::prony: return scenario.viscous_contact();
    case Viscosity::kelvin_voigt: break;
  }
  return false;
}

double radiation_compliance(const Scene& scene) {
  const tissue::Uniaxial& measured = scene.specimen->measured;
  const double shear = measured.young_modulus / (2.0 * (1.0 + measured.poisson_ratio));
  // 3.4 (1 - nu) / (4 G)^2 sqrt(rho G)
  return 0.2125 * (1.0 - measured.poisson_ratio) / shear *
         std::sqrt(*scene.scenario.tissue.density / shear);
}

}  // namespace palpate::scene
