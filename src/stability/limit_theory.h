// The stability limit of the time step according to theory, for every method and damping.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/integrators.h"
#include "tissue/viscous.h"

namespace palpate::stability {

using Integrator = scenario::Solver::Integrator;

// A time integration method: an integrator of scenarios, or central differences whose damping force
// `lags`, that is, uses the velocity of the previous step, (u(t) - u(t - dt)) / dt.
struct Method {
  Integrator integrator = Integrator::central_difference;
  bool lags = false;

  bool operator==(const Method&) const = default;
  [[nodiscard]] bool explicit_steps() const { return about(integrator).explicit_steps; }
  [[nodiscard]] std::string name() const {
    return lags ? "lagged_velocity" : about(integrator).word;
  }
};
inline constexpr Method lagged{.lags = true};

// Every method: the integrators in the order of their words, then `lagged`.
[[nodiscard]] std::vector<Method> methods();

// The limit of the time step, s, for a body with the highest `frequency` omega (1/s). With
// C = drag + tau omega^2 (1/s) and zeta = C / (2 omega):
//   central_difference   dt omega = 2
//   lagged_velocity      dt omega = 2 (sqrt(1 + zeta^2) - zeta);
//                        with Kelvin-Voigt dt = -tau + sqrt(tau^2 + 4 / omega^2)
//   semi_implicit_euler  dt omega = 2 (sqrt(1 + zeta^2) + zeta)
// each from the root -1 of the characteristic polynomial. A Maxwell branch contributes the fraction
// (2 / x) tanh(x / 2) of its stiffness, x = dt / time, as its memory is exact for linear courses:
//   dt^2 omega^2 (1 + sum of ratio (2 / x) tanh(x / 2)) + ... = 4 + ...
// The limit thus lies between those of the unrelaxed and of the relaxed tissue.
// Nothing for methods without a limit.              docs/theory.md [explicit_limit], [branch_limit]
[[nodiscard]] std::optional<double> limit_theory(const Method& method, double frequency,
                                                 const tissue::ViscousLaw& law);

// The damping ratio of a mode of `frequency` (1/s) by nodal drag and Kelvin-Voigt dashpots.
[[nodiscard]] double damping_ratio(double frequency, const tissue::ViscousLaw& law);

// |A|, the factor by which one step changes the amplitude of an undamped mode, x = omega dt: 1 for
// methods that only shift its phase, 1 / sqrt(1 + x^2) for implicit Euler, |R(i x)| for TR-BDF2.
// Nothing for methods without inertia and beyond a limit.                  docs/theory.md [tr_bdf2]
[[nodiscard]] std::optional<double> amplification(Integrator integrator, double omega_step);

// The factor by which one step of central differences beyond the limit, x = omega dt > 2, increases
// the amplitude of an undamped mode: the larger root of s^2 - (x^2 - 2) s + 1.
[[nodiscard]] double growth_beyond(double omega_step);

}  // namespace palpate::stability
