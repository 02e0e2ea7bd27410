// What theory says of the time step that a method is stable below.
#pragma once

#include <optional>
#include <string_view>

#include "tissue/viscous.h"

namespace palpate::study {

// Central differences whose damper takes the velocity of the step before, (u(t) - u(t - dt)) / dt:
// no word of a scenario, but what comes of eq. (12) where D is moved to the right side.
inline constexpr std::string_view lagged = "lagged_velocity";

// The limit of the step, s, of the mode of `frequency` omega (1/s), which is a body's highest. With
// C = drag + tau omega^2 (1/s) and zeta = C / (2 omega):
//   central_difference   dt omega = 2
//   lagged_velocity      dt omega = 2 (sqrt(1 + zeta^2) - zeta);
//                        of Kelvin-Voigt dt = -tau + sqrt(tau^2 + 4 / omega^2)
//   semi_implicit_euler  dt omega = 2 (sqrt(1 + zeta^2) + zeta)
// each from the root -1 of its characteristic polynomial. Branches behind dashpots hold the root -1
// by (2 / x) tanh(x / 2) of their stiffness, x = dt / time: their memory passes exactly through a
// linear course, and a swing between +e and -e is one:
//   dt^2 omega^2 (1 + sum of ratio (2 / x) tanh(x / 2)) + ... = 4 + ...
// so that the limit lies between those of the tissue at once and the relaxed one.
// Nothing for methods without a limit, and for words that are no method.    docs/theory.md (42)
[[nodiscard]] std::optional<double> limit_theory(std::string_view method, double frequency,
                                                 const tissue::ViscousLaw& law);

// The damping ratio of that mode by drag and by Kelvin-Voigt's dashpots.
[[nodiscard]] double damping_ratio(double frequency, const tissue::ViscousLaw& law);

// |A|, what a step of dt leaves of the amplitude of an undamped mode, x = omega dt: 1 of methods
// that only move its phase, 1 / sqrt(1 + x^2) of implicit Euler, and of TR-BDF2 with
// gamma = 2 - sqrt 2, from both its stages. Nothing for methods not known here, and beyond a
// limit.
[[nodiscard]] std::optional<double> amplification(std::string_view method, double omega_step);

// The growth of the amplitude in a step of central differences of an undamped mode beyond its
// limit, x = omega dt > 2: the greater root of s^2 - (x^2 - 2) s + 1.
[[nodiscard]] double growth_beyond(double omega_step);

}  // namespace palpate::study
