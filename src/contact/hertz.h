// Hertz contact of a sphere with an elastic body: eq. (1)-(3) of Chen 2007 in SI units.
#pragma once

#include <cmath>
#include <numbers>

namespace palpate::contact {

// Elastic properties of one of the two bodies in contact.
struct Elastic {
  double young_modulus = 0.0;  // Pa; infinite for a rigid body
  double poisson_ratio = 0.0;

  // lambda = (1 - nu^2) / E, in 1/Pa           Chen 2007 eq. (2); docs/theory.md [modulus]
  [[nodiscard]] double compliance() const;
};

namespace hertz {

// E* = 1 / (lambda_1 + lambda_2), Pa. The compliances are in 1/Pa, not both zero.
[[nodiscard]] double effective_modulus(double compliance_1, double compliance_2);

// 1/R = 1/R_1 + kappa: a sphere of radius R_1 (m) on a surface of curvature kappa (1/m, convex
// positive, 0 on a flat). Requires R_1 kappa > -1; otherwise the surfaces conform and Hertz's
// theory does not hold. docs/theory.md [radius]
[[nodiscard]] double effective_radius(double sphere_radius, double curvature);

// F = 4/3 E* sqrt(R) h^(3/2), N, for h (m), R (m), E* (Pa); 0 for h <= 0.  docs/theory.md [hertz]
[[nodiscard]] double force(double depth, double radius, double modulus);

// The depth (m) for a force (N): the inverse of `force`.
[[nodiscard]] double depth(double force, double radius, double modulus);

// dF/dh = 2 E* sqrt(R h), N/m.
[[nodiscard]] double stiffness(double depth, double radius, double modulus);

// a = sqrt(R h), m; identical to eq. (3)'s [3/4 F (lambda_1 + lambda_2) R]^(1/3).
[[nodiscard]] double contact_radius(double depth, double radius);

// p_0 = 3 F / (2 pi a^2), Pa, compression positive; 0 without contact.
[[nodiscard]] double peak_pressure(double force, double contact_radius);

}  // namespace hertz

// The surface displacement (m) at the distance `r` (m) from the centre of a contact of radius `a`
// (m; 0 for a point load) that carries `force` (N), on a half-space with E' = E / (1 - nu^2) (Pa).
//                                       K. L. Johnson 1985, eq. (3.42); docs/theory.md [half_space]
[[nodiscard]] inline double half_space_surface_displacement(double r, double force, double a,
                                                            double plane_modulus) {
  if (a <= 0.0) return force / (std::numbers::pi * plane_modulus * r);
  // u = pi p0 (2 a^2 - r^2) / (4 a E') inside, and outside
  // u = p0 [(2 a^2 - r^2) asin(a/r) + a sqrt(r^2 - a^2)] / (2 a E'), p0 = 3 F / (2 pi a^2)
  const double scale = 3.0 * force / (4.0 * std::numbers::pi * a * a * a * plane_modulus);
  if (r <= a) return scale * 0.5 * std::numbers::pi * (2.0 * a * a - r * r);
  return scale * ((2.0 * a * a - r * r) * std::asin(a / r) + a * std::sqrt((r - a) * (r + a)));
}

}  // namespace palpate::contact
