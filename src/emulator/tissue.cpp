// Viscoelastic contact of a sphere, exact if depth^(3/2) is linear in time during each step.
#include "emulator/tissue.h"

#include <cmath>

#include "emulator/files.h"

namespace emulator {

void fields(FieldVisitor& visitor, TissueSettings& settings) {
  using palpate::above;
  visitor.quantity({"E0", "instantaneous Young's modulus"}, settings.E0, unit::kPa, above(0.0));
  visitor.quantity({"Einf", "relaxed Young's modulus"}, settings.E_inf, unit::kPa, above(0.0));
  visitor.quantity({"tau", "relaxation time"}, settings.tau, unit::s, above(0.0));
  visitor.number({"nu", "Poisson's ratio"}, settings.nu, palpate::between(0.0, 0.5));
  visitor.quantity({"R", "radius of the indenter"}, settings.R, unit::mm, above(0.0));
  visitor.quantity({"surface", "height of the undeformed surface"}, settings.surface, unit::mm, {});
}

TissueSettings read_tissue(const std::string& path) {
  TissueSettings settings;
  const palpate::Node file =
      read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  if (settings.E0 < settings.E_inf)
    refuse(file, "E0", "`E0` is below `Einf`, and a modulus relaxes to less; give a larger `E0`");
  return settings;
}

Tissue make_tissue(const TissueSettings& settings, double step) {
  const double decay = std::exp(-step / settings.tau);
  return {.settings = settings,
          .step = step,
          .coefficient = 4.0 / 3.0 * std::sqrt(settings.R) / (1.0 - settings.nu * settings.nu),
          .decay = decay,
          .gain = (1.0 - decay) * settings.tau / step};
}

// F(t) = 4/3 sqrt(R)/(1 - nu^2) int_0^t E(t - s) d(h^(3/2)): Lee and Radok 1960, while the contact
// grows. With one exponential in E, F = C (E_inf y + (E0 - E_inf) q), y = h^(3/2), q' = y' - q/tau.
// For y linear in a step, q1 = q0 e^(-dt/tau) + (y1 - y0) (1 - e^(-dt/tau)) tau/dt.
// During unloading the same formula is used and F is cut at zero: the surface does not adhere.
double press(Tissue& tissue, double depth) {
  const double above_zero = depth > 0.0 ? depth : 0.0;
  const double next = above_zero * std::sqrt(above_zero);
  tissue.memory = tissue.memory * tissue.decay + (next - tissue.indentation) * tissue.gain;
  tissue.indentation = next;
  return force_of(tissue);
}

double force_of(const Tissue& tissue) {
  const TissueSettings& s = tissue.settings;
  if (tissue.indentation <= 0.0) return 0.0;
  const double force =
      tissue.coefficient * (s.E_inf * tissue.indentation + (s.E0 - s.E_inf) * tissue.memory);
  return force > 0.0 ? force : 0.0;
}

}  // namespace emulator
