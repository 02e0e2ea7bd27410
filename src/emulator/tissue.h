// The emulator's own soft tissue: a rigid sphere on a viscoelastic half-space, in closed form.
#pragma once

#include <string>

namespace emulator {

// Young's modulus relaxes as a standard linear solid, E(t) = E_inf + (E0 - E_inf) exp(-t/tau).
struct TissueSettings {
  double E0 = 30e3;        // Pa, at once
  double E_inf = 12e3;     // Pa, after long
  double tau = 0.5;        // s
  double nu = 0.5;         // Poisson's ratio
  double R = 5e-3;         // m, of the indenter
  double surface = -2e-3;  // m, height of the undeformed surface
};

// Keys `E0`, `Einf`, `tau`, `nu`, `R`, `surface`; throws `Refused`.
[[nodiscard]] TissueSettings read_tissue(const std::string& path);

// The state of the contact; depth in m, force in N, pushing the indenter back.
struct Tissue {
  TissueSettings settings;
  double step;             // s, fixed
  double coefficient;      // m^0.5: 4/3 sqrt(R) / (1 - nu^2)
  double decay;            // exp(-step/tau)
  double gain;             // (1 - decay) tau / step
  double indentation = 0;  // m^1.5: depth^(3/2)
  double memory = 0;       // m^1.5: what of it the relaxing branch still feels
};

[[nodiscard]] Tissue make_tissue(const TissueSettings& settings, double step);

// One step to a new depth (m, negative above the surface). Returns the force, N, never negative.
double press(Tissue& tissue, double depth);

// The force now, N.
[[nodiscard]] double force_of(const Tissue& tissue);

// After a step to `depth` at t = 0: F(t) = 4/3 sqrt(R)/(1 - nu^2) E(t) depth^(3/2).
[[nodiscard]] double relaxation_force(const TissueSettings& settings, double depth, double t);

}  // namespace emulator
