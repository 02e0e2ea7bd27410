// Hertz contact of a sphere with an elastic body: eq. (1)-(3) of Chen 2007 in SI units, and with a
// body whose two principal curvatures differ.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

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

// The contact of a sphere by the two principal curvatures: its force is that of a sphere of
// `force_radius` on a flat, docs/theory.md [ellipse_force].
struct EllipticLaw {
  double force_radius = 0.0;  // m
  double along_radius = 0.0;  // m: square of the longer semi-axis, along the least curvature, over
                              // the depth
  double axis_ratio = 1.0;    // of the shorter semi-axis to the longer, in (0, 1]
};

// From the sphere's radius R_1 (m) and the body's principal curvatures (1/m, convex
// positive, in any order). Empty if the surfaces conform, 1/R_1 + kappa <= 0 in a direction, or a
// number is not finite. Accurate to rounding until 1/R_1 + kappa in one direction is 1e-30 of that
// in the other. As it goes to 0 the ellipse becomes a line and the force grows without bound,
// although the half-space is no longer valid; see nearly_conforming(). docs/theory.md [axes]
[[nodiscard]] std::optional<EllipticLaw> elliptic_law(double sphere_radius, double kappa_1,
                                                      double kappa_2);

// Whether the body is so hollow in a direction (kappa < -0.5 / R_1) that the contact is wide
// compared with the sphere and Hertz's law is inaccurate.
[[nodiscard]] bool nearly_conforming(double sphere_radius, double kappa_1, double kappa_2);

// Effective radii for `hertz::force` from both curvatures, m: by their mean (Chen 2007) and by the
// geometric mean. They require R_1 kappa > -1 in both directions. Compared with the ellipse the
// force is 4 % and 1 % low if the ratio of the relative curvatures is 1:2, and 18 % and 5 % at 1:5.
//                                                                 docs/theory.md [circles]
[[nodiscard]] double mean_radius(double sphere_radius, double kappa_1,
                                 double kappa_2);  // Chen 2007
[[nodiscard]] double geometric_radius(double sphere_radius, double kappa_1, double kappa_2);

}  // namespace palpate::contact
