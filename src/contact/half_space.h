// Normal surface displacement of a half-space under and around a Hertz contact.
#pragma once

#include <cmath>
#include <numbers>

namespace palpate::contact {

// The sinking (m) at the distance `r` (m) from the centre of a contact of radius `a` (m; 0 for a
// point load) that carries `force` (N), on a half-space with E' = E / (1 - nu^2) (Pa).
//                                       K. L. Johnson 1985, eq. (3.42); docs/theory.md [half_space]
[[nodiscard]] inline double half_space_sinking(double r, double force, double a,
                                               double plane_modulus) {
  if (a <= 0.0) return force / (std::numbers::pi * plane_modulus * r);
  // u = pi p0 (2 a^2 - r^2) / (4 a E') inside, and outside
  // u = p0 [(2 a^2 - r^2) asin(a/r) + a sqrt(r^2 - a^2)] / (2 a E'), p0 = 3 F / (2 pi a^2)
  const double scale = 3.0 * force / (4.0 * std::numbers::pi * a * a * a * plane_modulus);
  if (r <= a) return scale * 0.5 * std::numbers::pi * (2.0 * a * a - r * r);
  return scale * ((2.0 * a * a - r * r) * std::asin(a / r) + a * std::sqrt((r - a) * (r + a)));
}

}  // namespace palpate::contact
