// The highest frequency of the springs at their stiffest, and the time steps that follow from it.
#include "scene/time_plan.h"

#include <algorithm>
#include <cmath>

#include "scenario/integrators.h"
#include "scene/scene.h"
#include "tissue/network.h"

namespace palpate::scene {
namespace {

using integrate::DampingVelocity;

// The limit for the specimen's highest mode, on which damping acts most: [limit], [explicit_limit].
double limit_of_explicit_steps(const scenario::Resolved::Solver& solver,
                               const tissue::ViscousLaw& law, double squared,
                               const ContactRate& contact) {
  const DampingVelocity velocity = about(solver.integrator).explicit_steps
                                       ? scenario::damping_velocity(solver)
                                       : DampingVelocity::centred;
  const bool dashpots = law.kind == tissue::Viscosity::kelvin_voigt;
  const double limit =
      integrate::explicit_limit(velocity, {.squared = squared + contact.squared,
                                           .rate = dashpots ? law.time * squared : law.drag,
                                           .forces = contact.damping});
  // With `ahead`, dashpots stabilise spring modes, but no contact, below 2 tau [explicit_limit].
  if (velocity != DampingVelocity::ahead || !dashpots || limit >= 2.0 * law.time) return limit;
  return integrate::explicit_limit(velocity,
                                   {.squared = contact.squared, .forces = contact.damping});
}

}  // namespace

double stability_limit(const scenario::Resolved& scenario, const Specimen& specimen,
                       const ContactRate& contact) {
  const double squared = specimen.law.instantaneous_ratio() *
                         tissue::largest_frequency_squared(specimen.network, specimen.held);
  return limit_of_explicit_steps(scenario.solver, specimen.law, squared, contact);
}

double shear_speed(const scenario::Resolved::Tissue& tissue) {
  return std::sqrt(tissue.young_modulus / (2.0 * (1.0 + tissue.poisson_ratio) * tissue.density));
}

TimePlan plan_time(const scenario::Resolved& scenario, const Specimen& specimen,
                   const ContactRate& contact) {
  using Integrator = scenario::Solver::Integrator;
  const scenario::Resolved::Solver& solver = scenario.solver;
  TimePlan plan;
  plan.contact = contact;
  plan.time_step = solver.time_step.value_or(scenario.output.interval);

  constexpr double safety = 0.9;
  // Methods of first order have an error of about x/2 e^-1 after one viscous time, x = dt / tau.
  constexpr double euler_steps_a_time = 50.0;
  double wanted = plan.time_step;
  if (about(solver.integrator).explicit_steps) {
    plan.limit = stability_limit(scenario, specimen, contact);
    wanted = safety * *plan.limit;
    // With `ahead`, Kelvin-Voigt is stable in steps far longer than its motion lasts.
    if (scenario::damping_velocity(solver) == DampingVelocity::ahead &&
        specimen.law.kind == tissue::Viscosity::kelvin_voigt)
      wanted = std::min(wanted, specimen.law.time / euler_steps_a_time);
  } else if (solver.integrator == Integrator::backward_difference &&
             specimen.law.shortest_time() > 0.0) {
    wanted = specimen.law.shortest_time() / euler_steps_a_time;
  } else if (solver.integrator == Integrator::tr_bdf2 && specimen.law.shortest_time() > 0.0) {
    // The error of TR-BDF2 is about 0.04 x^2 e^-1 then.
    wanted = specimen.law.shortest_time() / 5.0;
  } else if (solver.integrator == Integrator::modal && inertia_reaches_force(scenario)) {
    // The load of a step is constant: steps as long as the period of a low mode would excite it,
    // again and again. A quarter of the way of a shear wave through the body is far below that.
    constexpr double frame = 1e-3;  // s, however stiff the tissue
    const double height = specimen.high.z() - specimen.low.z();
    wanted = std::max(frame, 0.25 * height / shear_speed(scenario.tissue));
  }
  const double enough = std::max(1.0, std::ceil(plan.time_step / wanted));
  plan.substeps = solver.substeps.value_or(static_cast<int>(std::min(enough, 1e9)));
  plan.substep = plan.time_step / plan.substeps;
  return plan;
}

bool inertia_reaches_force(const scenario::Resolved& scenario) {
  using tissue::Viscosity;
  if (scenario.uniform() || !scenario.meshed() ||
      scenario.contact.coupling != contact::Coupling::consistent ||
      !about(scenario.solver.integrator).inertia ||
      scenario.solver.kinematics != scenario::Solver::Kinematics::linear)
    return false;
  switch (scenario.tissue.viscosity) {
    case Viscosity::none:
    case Viscosity::nodal_drag: return true;
    case Viscosity::standard_linear_solid:
    case Viscosity::prony: return scenario::viscous_contact(scenario);
    case Viscosity::kelvin_voigt: break;
  }
  return false;
}

double radiation_compliance(const Scene& scene) {
  const tissue::Uniaxial& measured = scene.specimen->measured;
  const double shear = measured.young_modulus / (2.0 * (1.0 + measured.poisson_ratio));
  // 3.4 (1 - nu) / (4 G)^2 sqrt(rho G)
  return 0.2125 * (1.0 - measured.poisson_ratio) / shear *
         std::sqrt(scene.scenario.tissue.density / shear);
}

}  // namespace palpate::scene
