// Kelvin-Voigt and the standard linear solid in one recurrence.
#include "tissue/viscous.h"

#include <cmath>

namespace palpate::tissue {

// exp here is evaluated once a run, outside the step.
MemoryStep MemoryStep::exact(double time_step, double time) {
  const double x = time_step / time;
  const double keep = std::exp(-x);
  const double mean = -std::expm1(-x) / x;  // (1 - e^-x) / x
  return {keep, mean - keep, 1.0 - mean};
}

MemoryStep MemoryStep::held(double time_step, double time) {
  const double x = time_step / time;
  return {std::exp(-x), 0.0, -std::expm1(-x)};
}

MemoryStep MemoryStep::first_order(double time_step, double time) {
  const double x = time_step / time;
  return {1.0 / (1.0 + x), 0.0, x / (1.0 + x)};
}

StepTension step_tension(const ViscousLaw& law, const Memory& memory, const MemoryStep& step,
                         double elongation) {
  // A dashpot that is stretched at once gives an impulse and is then as slack as before.
  if (law.kind == Viscosity::kelvin_voigt && step.end == 0.0) return {elongation, 1.0};
  if (law.kind == Viscosity::kelvin_voigt) {
    // e_1 = keep e_0 + begin s_0/k + end s_1/k, solved for s_1/k          docs/theory.md (36)
    const double past = step.keep * memory.elongation + step.begin * memory.internal;
    return {(elongation - past) / step.end, 1.0 / step.end};
  }
  if (law.kind == Viscosity::standard_linear_solid) {
    // s/k = e + k_1/k (e - q_1)                                          docs/theory.md (37)
    const double past = step.keep * memory.internal + step.begin * memory.elongation;
    const double branch = elongation * (1.0 - step.end) - past;
    return {elongation + law.branch * branch, 1.0 + law.branch * (1.0 - step.end)};
  }
  return {elongation, 1.0};
}

Memory remembered(const ViscousLaw& law, const Memory& memory, const MemoryStep& step,
                  double elongation) {
  if (law.kind == Viscosity::kelvin_voigt)
    return {elongation, step_tension(law, memory, step, elongation).value};
  return {elongation,
          step.keep * memory.internal + step.begin * memory.elongation + step.end * elongation};
}

}  // namespace palpate::tissue
