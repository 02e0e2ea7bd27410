// The emulator's soft tissue: a rigid sphere on a viscoelastic half-space, without palpate's code.
#pragma once

#include <string>

#include "base/fields.h"

namespace emulator {

// Young's modulus relaxes as a standard linear solid, E(t) = E_inf + (E0 - E_inf) exp(-t/tau).
struct TissueSettings {
  double E0 = 30e3;        // Pa, instantaneous modulus
  double E_inf = 12e3;     // Pa, relaxed modulus
  double tau = 0.5;        // s
  double nu = 0.5;         // Poisson's ratio
  double R = 5e-3;         // m, of the indenter
  double surface = -2e-3;  // m, height of the undeformed surface
};

void fields(palpate::FieldVisitor& visitor, TissueSettings& settings);
// Throws InputError.
[[nodiscard]] TissueSettings read_tissue(const std::string& path);

// The state of the contact.
struct Tissue {
  TissueSettings settings;
  double step;             // s, fixed
  double coefficient;      // m^0.5: 4/3 sqrt(R) / (1 - nu^2)
  double decay;            // exp(-step/tau)
  double gain;             // (1 - decay) tau / step
  double indentation = 0;  // m^1.5: depth^(3/2)
  double memory = 0;       // m^1.5: the part of `indentation` that has not relaxed: q of press()
};

[[nodiscard]] Tissue make_tissue(const TissueSettings& settings, double step);

// Advances by one step to a new depth (m, negative above the surface). Returns force_of().
double press(Tissue& tissue, double depth);

// N, the present force on the indenter; never negative.
[[nodiscard]] double force_of(const Tissue& tissue);

}  // namespace emulator
