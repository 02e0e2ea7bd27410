// Limits of the time step from the root -1 of characteristic polynomials.
#include "stability/limit_theory.h"

#include <cmath>
#include <complex>

#include "base/numerics.h"

namespace palpate::stability {
namespace {

// Ratio of omega^2 of a mode that changes its sign in every step to that of the relaxed tissue.
double alternating_ratio(const tissue::ViscousLaw& law, double time_step) {
  double ratio = 1.0;
  for (const tissue::Branch& branch : law.branches) {
    const double x = time_step / branch.time;
    // q = e (1 - (2 / x) tanh(x / 2)) with MemoryStep::exact if e and q alternate in sign.
    ratio += branch.ratio * (x > 0.0 ? 2.0 / x * std::tanh(0.5 * x) : 1.0);
  }
  return ratio;
}

// docs/theory.md [explicit_limit] with [branch_limit], left side minus 4; negative if stable.
// `side` is s / 2: 0 for centred damping, 1 if the velocity lags, -1 if it is the new one.
double excess(double time_step, double side, double frequency, const tissue::ViscousLaw& law) {
  const double damping = law.drag + law.time * frequency * frequency;
  return time_step * time_step * frequency * frequency * alternating_ratio(law, time_step) +
         2.0 * side * damping * time_step - 4.0;
}

}  // namespace

std::vector<Method> methods() {
  std::vector<Method> all;
  for (std::size_t i = 0; i < scenario::integrator_table.size(); ++i)
    all.push_back({static_cast<Integrator>(i)});
  all.push_back(lagged);
  return all;
}

std::optional<double> limit_theory(const Method& method, double frequency,
                                   const tissue::ViscousLaw& law) {
  double side = 0.0;
  switch (method.integrator) {
    case Integrator::central_difference: side = method.lags ? 1.0 : 0.0; break;
    case Integrator::semi_implicit_euler: side = -1.0; break;
    case Integrator::backward_difference:
    case Integrator::tr_bdf2:
    case Integrator::quasi_static:
    case Integrator::modal: return std::nullopt;
  }
  const auto over = [&](double time_step) { return excess(time_step, side, frequency, law); };
  double high = 2.0 / frequency;
  while (over(high) < 0.0) high *= 2.0;
  return numerics::root({0.0, high}, over).low;
}

double damping_ratio(double frequency, const tissue::ViscousLaw& law) {
  return 0.5 * (law.drag / frequency + law.time * frequency);
}

std::optional<double> amplification(Integrator integrator, double omega_step) {
  const double x = omega_step;
  switch (integrator) {
    case Integrator::central_difference:
    case Integrator::semi_implicit_euler: return x < 2.0 ? std::optional(1.0) : std::nullopt;
    case Integrator::backward_difference: return 1.0 / std::sqrt(1.0 + x * x);
    case Integrator::tr_bdf2: {
      // y' = i x y: the trapezoidal rule to gamma, then the second-order backward difference.
      const std::complex<double> z(0.0, x);
      const double gamma = 2.0 - std::sqrt(2.0);
      const std::complex<double> middle = (1.0 + 0.5 * gamma * z) / (1.0 - 0.5 * gamma * z);
      const double share = 1.0 / (gamma * (2.0 - gamma));
      const std::complex<double> end = (share * middle - share * (1.0 - gamma) * (1.0 - gamma)) /
                                       (1.0 - (1.0 - gamma) / (2.0 - gamma) * z);
      return std::abs(end);
    }
    case Integrator::modal: return 1.0;
    case Integrator::quasi_static: break;
  }
  return std::nullopt;
}

double growth_beyond(double omega_step) {
  const double half = 0.5 * omega_step * omega_step - 1.0;
  return half + std::sqrt(half * half - 1.0);
}

}  // namespace palpate::stability
