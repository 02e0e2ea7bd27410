// omega_max of the springs at their stiffest, and what follows for the step.
#include "scene/time_plan.h"

#include <algorithm>
#include <cmath>

#include "scenario/integrators.h"
#include "scene/scene.h"
#include "tissue/stable_step.h"

namespace palpate::scene {
namespace {

using integrate::DampingVelocity;

// Of the specimen's own modes the highest, whose damping counts most; docs/theory.md (42), (76)
double limit_of_explicit_steps(const scenario::Solver& solver, const tissue::ViscousLaw& law,
                               double squared, const ContactRate& contact) {
  const DampingVelocity velocity = scenario::explicit_steps(solver.integrator)
                                       ? scenario::damping_velocity(solver)
                                       : DampingVelocity::centred;
  const bool dashpots = law.kind == tissue::Viscosity::kelvin_voigt;
  const double limit =
      integrate::explicit_limit(velocity, {.squared = squared + contact.squared,
                                           .rate = dashpots ? law.time * squared : law.drag,
                                           .forces = contact.damping});
  // Ahead, dashpots hold all that the springs do in steps below 2 tau; the contact they do not.
  if (velocity != DampingVelocity::ahead || !dashpots || limit >= 2.0 * law.time) return limit;
  return integrate::explicit_limit(velocity,
                                   {.squared = contact.squared, .forces = contact.damping});
}

}  // namespace

TimePlan plan_time(const scenario::Scenario& scenario, const Specimen& specimen,
                   const ContactRate& contact) {
  using Integrator = scenario::Solver::Integrator;
  const scenario::Solver& solver = scenario.solver;
  TimePlan plan;
  plan.time_step = solver.time_step.value_or(scenario.output.interval);
  const double squared = specimen.law.instantaneous_ratio() *
                         tissue::largest_frequency_squared(specimen.network, specimen.held);
  plan.limit = limit_of_explicit_steps(solver, specimen.law, squared, contact);
  plan.frequency_squared = 4.0 / (plan.limit * plan.limit);

  constexpr double safety = 0.9;
  // Methods of first order err by about x/2 e^-1 at one viscous time, x = dt / tau.
  constexpr double euler_steps_a_time = 50.0;
  double wanted = plan.time_step;
  if (scenario::explicit_steps(solver.integrator)) {
    wanted = safety * plan.limit;
    // Ahead, dashpots are stable for steps in which their motion would be over.
    if (scenario::damping_velocity(solver) == DampingVelocity::ahead &&
        specimen.law.kind == tissue::Viscosity::kelvin_voigt)
      wanted = std::min(wanted, specimen.law.time / euler_steps_a_time);
  } else if (solver.integrator == Integrator::backward_difference &&
             specimen.law.shortest_time() > 0.0) {
    wanted = specimen.law.shortest_time() / euler_steps_a_time;
  } else if (solver.integrator == Integrator::tr_bdf2 && specimen.law.shortest_time() > 0.0) {
    // Of TR-BDF2 the error is about 0.04 x^2 e^-1 there.
    wanted = specimen.law.shortest_time() / 5.0;
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
