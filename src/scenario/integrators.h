// Names and properties of all integrators in one table, for plans, checks, `explain` and tests.
#pragma once

#include <optional>

#include "scenario/resolved.h"

namespace palpate::scenario {

struct IntegratorRow {
  const char* word;  // in scenarios
  const char* meaning;
  const char* told;               // in the output of `explain`
  std::optional<int> order = {};  // in time; none for an exact method
  bool explicit_steps = false;    // only stable below a limit
  bool inertia = true;
};
inline constexpr auto integrator_table = std::to_array<IntegratorRow>({
    {.word = "central_difference",
     .meaning = "explicit, eq. (12)",
     .told = "central differences",
     .order = 2,
     .explicit_steps = true},
    {.word = "semi_implicit_euler",
     .meaning = "explicit, the new velocity first; first order",
     .told = "semi-implicit Euler, the new velocity first",
     .order = 1,
     .explicit_steps = true},
    {.word = "backward_difference",
     .meaning = "implicit Euler, first order",
     .told = "backward differences (implicit Euler)",
     .order = 1},
    {.word = "tr_bdf2",
     .meaning = "implicit, second order, L-stable; two solves per step",
     .told = "TR-BDF2, two implicit stages per step",
     .order = 2},
    {.word = "quasi_static",
     .meaning = "no inertia",
     .told = "quasi-static steps, without inertia",
     .order = 2,
     .inertia = false},
    {.word = "modal",
     .meaning = "exact in time, linear only",
     .told = "modal coordinates, exact in time"},
});
static_assert(is_complete<Solver::Integrator>(integrator_table), "every integrator has its row");

[[nodiscard]] constexpr const IntegratorRow& about(Solver::Integrator integrator) {
  return integrator_table[as_index(integrator)];
}

// The number of modes that `modal` keeps by default.
inline constexpr int default_modes = 128;

// Whether modal steps may keep the lowest modes only, because the force takes the statics of the
// others from elsewhere or does not depend on the mesh's motion.  docs/theory.md [lowest_modes]
[[nodiscard]] inline bool lowest_modes_serve(const Resolved& scenario) {
  using contact::Coupling;
  using tissue::Viscosity;
  const Coupling coupling = scenario.contact.coupling;
  const bool relaxes = scenario.tissue.viscosity == Viscosity::standard_linear_solid ||
                       scenario.tissue.viscosity == Viscosity::prony;
  const bool serves = relaxes ? coupling == Coupling::consistent && viscous_contact(scenario)
                              : coupling == Coupling::one_way || coupling == Coupling::consistent;
  return !scenario.uniform() && serves && !scenario.solver.rings &&
         scenario.contact.curvature_on == Contact::CurvatureOn::rest;
}

// The velocity with which damping acts in explicit steps.
[[nodiscard]] inline integrate::DampingVelocity damping_velocity(const Resolved::Solver& solver) {
  if (solver.integrator == Solver::Integrator::semi_implicit_euler)
    return integrate::DampingVelocity::ahead;
  return solver.damping == Solver::Damping::lagged ? integrate::DampingVelocity::lagged
                                                   : integrate::DampingVelocity::centred;
}

}  // namespace palpate::scenario
