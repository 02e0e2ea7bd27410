// The stability limit of a specimen, and its time steps.
#pragma once

#include <optional>

#include "scenario/resolved.h"

namespace palpate::scene {

struct Scene;
struct Specimen;

// The addition to the fastest motion by a contact that acts back on the mesh: its stiffness k and
// damping C, times sum_j w_j^2 / m_j over the loaded nodes.
//                                                           docs/theory.md [limit], [contact_limit]
struct ContactRate {
  double squared = 0.0;  // 1/s^2
  double damping = 0.0;  // 1/s
};

// The time step (s) below which the chosen method is stable if it is explicit, or else central
// differences.                                                           docs/theory.md [limit]
[[nodiscard]] double stability_limit(const scenario::Resolved& scenario, const Specimen& specimen,
                                     const ContactRate& contact);

[[nodiscard]] double shear_speed(const scenario::Resolved::Tissue& tissue);  // m/s, of its waves

struct TimePlan {
  ContactRate contact;
  std::optional<double> limit;  // s, of the stability of the chosen method, if that is explicit
  double time_step = 0.0;       // s, of the scenario
  int substeps = 1;             // of a time step
  double substep = 0.0;         // s, the length of a solver step

  [[nodiscard]] bool stable() const { return !limit || substep < *limit; }
};

// Substeps of a time step: for explicit methods as many as keep it below 0.9 of the stability
// limit; for implicit Euler and TR-BDF2 as many as keep its error below 1 % after one viscous time;
// for `modal` as many as do not excite a low mode, in steps of 1 ms at least; else one.
// `solver.substeps` overrides this.                           docs/theory.md [limit]
[[nodiscard]] TimePlan plan_time(const scenario::Resolved& scenario, const Specimen& specimen,
                                 const ContactRate& contact);

// Whether the inertia of the tissue (and its nodal drag) affects the contact force:
// for `consistent`, in steps with inertia, if the static displacement of the mesh under its loads
// is known, so that the rest of its motion is due to inertia. False with non-linear kinematics,
// where the contact neglects the viscosity of the mesh, and with Kelvin-Voigt, whose dashpot would
// need the force that it determines. docs/theory.md [inertia]
[[nodiscard]] bool inertia_reaches_force(const scenario::Resolved& scenario);

// D = C / F'^2, m s/N, for the dashpot C by which a half-space with the network's E and nu and the
// tissue's density acts on a contact of stiffness F'. It is the same for every radius:
//   C = 3.4 a^2 sqrt(rho G) / (1 - nu),  F' = 4 G a / (1 - nu)
//                      Lysmer's analogue, Lysmer and Richart 1966; docs/theory.md [radiation]
[[nodiscard]] double radiation_compliance(const Scene& scene);

}  // namespace palpate::scene
