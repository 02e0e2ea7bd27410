// Hertz contact of a sphere with a body whose two principal curvatures differ.
#pragma once

#include <optional>

namespace palpate::contact {

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
