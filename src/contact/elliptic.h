// Hertz contact of a sphere with a body that curves differently in two directions.
#pragma once

#include <optional>

namespace palpate::contact {

// Half the axes of the contact ellipse, m.
struct SemiAxes {
  double along = 0.0;   // the longer one, in the direction of the least curvature
  double across = 0.0;  // in the direction of the greatest
};

// Everything that depends on curvatures and modulus, found once; the rest is + - * / and sqrt.
// Depths in m; without contact, at a depth of 0 or less, all answers are 0.
struct EllipticLaw {
  double modulus = 0.0;       // E*, Pa
  double force_radius = 0.0;  // m: the sphere on a flat that presses alike
  double along_radius = 0.0;  // m: along^2 / depth
  double axis_ratio = 1.0;    // across / along, in (0, 1]

  [[nodiscard]] double force(double depth) const;      // N
  [[nodiscard]] double stiffness(double depth) const;  // dF/dh, N/m
  [[nodiscard]] double depth(double force) const;      // the inverse of `force`
  [[nodiscard]] SemiAxes semi_axes(double depth) const;
  [[nodiscard]] double peak_pressure(double depth) const;  // Pa
  // At `x` along the longer axis and `y` across it from the centre, Pa; 0 outside the ellipse.
  [[nodiscard]] double pressure(double x, double y, double depth) const;
};

// E* (Pa), the sphere's radius R_1 (m) and the body's principal curvatures (1/m, convex positive,
// in any order). Empty where the surfaces conform, 1/R_1 + kappa <= 0 in a direction, or where a
// number is not finite. Good to rounding until 1/R_1 + kappa in one direction is 1e-30 of that in
// the other; as it goes to 0 the ellipse becomes a line and the force grows without bound, long
// after a half-space has ceased to be a model: `nearly_conforming` says when to stop believing.
//                                                                  docs/theory.md (23)-(25)
[[nodiscard]] std::optional<EllipticLaw> elliptic_law(double modulus, double sphere_radius,
                                                      double kappa_1, double kappa_2);

// Is the body hollow beyond half the sphere's curvature (kappa < -0.5 / R_1) in a direction? The
// contact then grows wide against the sphere, and Hertz's law is a poor one.
[[nodiscard]] bool nearly_conforming(double sphere_radius, double kappa_1, double kappa_2);

// Radii for `hertz::force` from both curvatures, m. Need R_1 kappa > -1 in both directions.
// Against the ellipse at a ratio 1:2 of the relative curvatures the force is 4 % and 1 % low, at
// 1:5 18 % and 5 %.                                                    docs/theory.md (26)
[[nodiscard]] double mean_radius(double sphere_radius, double kappa_1,
                                 double kappa_2);  // the paper
[[nodiscard]] double geometric_radius(double sphere_radius, double kappa_1, double kappa_2);

}  // namespace palpate::contact
