// The stability limit of a specimen, and the steps that respect it.
#pragma once

#include "scenario/scenario.h"

namespace palpate::scene {

struct Scene;
struct Specimen;

// What a contact that reads the mesh back adds to its fastest motion: stiffness k and damping C,
// times sum_j w_j^2 / m_j over the nodes that it presses.             docs/theory.md (42), (76)
struct ContactRate {
  double squared = 0.0;  // 1/s^2
  double damping = 0.0;  // 1/s
};

struct TimePlan {
  double frequency_squared = 0.0;  // 1/s^2, 4 / limit^2: without dashpots omega_max^2
  double limit = 0.0;      // s, of explicit steps: of central differences, unless another is chosen
  double time_step = 0.0;  // s, of the scenario
  int substeps = 1;        // it is cut into
  double substep = 0.0;    // s, what is stepped

  [[nodiscard]] bool stable() const { return substep < limit; }
};

// For explicit methods as many substeps as stability asks for, at 0.9 of the limit; for implicit
// Euler and TR-BDF2 as many as keep their error below a hundredth at the viscous time; one
// otherwise.
[[nodiscard]] TimePlan plan_time(const scenario::Scenario& scenario, const Specimen& specimen,
                                 const ContactRate& contact);

// Whether inertia of the tissue (and its drag against the ground) reaches the contact force: with
// `consistent`, in steps that have inertia, where the static answer of the mesh under the same
// loads is known, so that what is left of its motion is inertia. It is not known of springs that
// turn, nor of a mesh whose viscosity the contact leaves out; and Kelvin-Voigt's contact has a
// dashpot, which would need the force within the step that it makes.    docs/theory.md (74)
[[nodiscard]] bool inertia_reaches_force(const scenario::Scenario& scenario);

// D = C / F'^2, m s/N: the dashpot C that a half-space of the network's E and nu and the tissue's
// density is to a contact of the stiffness F', the same for every radius; by Lysmer's analogue
//   C = 3.4 a^2 sqrt(rho G) / (1 - nu),  F' = 4 G a / (1 - nu)
//                                                Lysmer and Richart 1966; docs/theory.md (75)
[[nodiscard]] double radiation_compliance(const Scene& scene);

}  // namespace palpate::scene
