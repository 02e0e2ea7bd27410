// Hereditary contact of a sphere, stepped exactly for an indentation that is linear in each step.
#include "emulator/tissue.h"

#include <cmath>

#include "emulator/settings.h"

namespace emulator {

TissueSettings read_tissue(const std::string& path) {
  const Document document = read_toml(path);
  Table table(document, document.root);
  TissueSettings settings;
  settings.E0 = table.quantity("E0", settings.E0, Quantity::pressure);
  settings.E_inf = table.quantity("Einf", settings.E_inf, Quantity::pressure);
  settings.tau = table.quantity("tau", settings.tau, Quantity::time);
  settings.nu = table.number("nu", settings.nu);
  settings.R = table.quantity("R", settings.R, Quantity::length);
  settings.surface = table.quantity("surface", settings.surface, Quantity::length);
  table.finish();
  if (settings.E_inf <= 0.0) throw Refused(table.place("Einf") + "wants to be positive");
  if (settings.E0 < settings.E_inf)
    throw Refused(table.place("E0") + "is below `Einf`; a solid relaxes downwards");
  if (settings.tau <= 0.0) throw Refused(table.place("tau") + "wants to be positive");
  if (settings.R <= 0.0) throw Refused(table.place("R") + "wants to be positive");
  if (settings.nu < 0.0 || settings.nu > 0.5)
    throw Refused(table.place("nu") + "wants to lie between 0 and 0.5");
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
// grows. With E of one exponential that is F = C (E_inf y + (E0 - E_inf) q), y = h^(3/2),
// q' = y' - q/tau; for y linear in a step, q1 = q0 e^(-dt/tau) + (y1 - y0) (1 - e^(-dt/tau))
// tau/dt. On the way out the same sum is used and cut at zero: a surface that does not stick.
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

double relaxation_force(const TissueSettings& s, double depth, double t) {
  const double modulus = s.E_inf + (s.E0 - s.E_inf) * std::exp(-t / s.tau);
  return 4.0 / 3.0 * std::sqrt(s.R) / (1.0 - s.nu * s.nu) * modulus * depth * std::sqrt(depth);
}

}  // namespace emulator
