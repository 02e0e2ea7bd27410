// Roots -1 of characteristic polynomials.
#include "study/limit_theory.h"

#include <cmath>
#include <complex>

namespace palpate::study {
namespace {

// omega^2 of a mode whose displacement alternates, over that of the relaxed tissue.
double alternating_ratio(const tissue::ViscousLaw& law, double time_step) {
  double ratio = 1.0;
  for (const tissue::Branch& branch : law.branches) {
    const double x = time_step / branch.time;
    // q = e (1 - (2 / x) tanh(x / 2)) under MemoryStep::exact, e and q both turning their signs.
    ratio += branch.ratio * (x > 0.0 ? 2.0 / x * std::tanh(0.5 * x) : 1.0);
  }
  return ratio;
}

// Below 0 where a step is stable: what the characteristic polynomial at -1 lacks. `side` is the
// damper's: 0 in the left matrix of central differences, which does not show at the root -1; 1 of a
// velocity that lags; -1 of one that is the new one.
double excess(double time_step, double side, double frequency, const tissue::ViscousLaw& law) {
  const double damping = law.drag + law.time * frequency * frequency;
  return time_step * time_step * frequency * frequency * alternating_ratio(law, time_step) +
         2.0 * side * damping * time_step - 4.0;
}

}  // namespace

std::optional<double> limit_theory(std::string_view method, double frequency,
                                   const tissue::ViscousLaw& law) {
  double side = 0.0;
  if (method == lagged)
    side = 1.0;
  else if (method == "semi_implicit_euler")
    side = -1.0;
  else if (method != "central_difference")
    return std::nullopt;
  double low = 0.0;
  double high = 2.0 / frequency;
  while (excess(high, side, frequency, law) < 0.0) high *= 2.0;
  for (int i = 0; i < 200; ++i) {  // to the last digit: a halving a round
    const double middle = 0.5 * (low + high);
    (excess(middle, side, frequency, law) < 0.0 ? low : high) = middle;
  }
  return low;
}

double damping_ratio(double frequency, const tissue::ViscousLaw& law) {
  return 0.5 * (law.drag / frequency + law.time * frequency);
}

std::optional<double> amplification(std::string_view method, double omega_step) {
  const double x = omega_step;
  if (method == "central_difference" || method == "semi_implicit_euler") {
    if (x < 2.0) return 1.0;
    return std::nullopt;
  }
  if (method == "modal") return 1.0;
  if (method == "backward_difference") return 1.0 / std::sqrt(1.0 + x * x);
  if (method == "tr_bdf2") {
    // y' = i x y: the trapezoidal rule to gamma, then BDF2 over both.
    const std::complex<double> z(0.0, x);
    const double gamma = 2.0 - std::sqrt(2.0);
    const std::complex<double> middle = (1.0 + 0.5 * gamma * z) / (1.0 - 0.5 * gamma * z);
    const double share = 1.0 / (gamma * (2.0 - gamma));
    const std::complex<double> end = (share * middle - share * (1.0 - gamma) * (1.0 - gamma)) /
                                     (1.0 - (1.0 - gamma) / (2.0 - gamma) * z);
    return std::abs(end);
  }
  return std::nullopt;
}

double growth_beyond(double omega_step) {
  const double half = 0.5 * omega_step * omega_step - 1.0;
  return half + std::sqrt(half * half - 1.0);
}

}  // namespace palpate::study
