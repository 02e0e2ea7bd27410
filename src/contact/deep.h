// A sphere at a depth that is not small against its radius: a fitted factor for neo-Hookean tissue,
// and Sneddon's linear elastic solution.
#pragma once

#include <optional>

namespace palpate::contact {

// The ratio of the force to Hertz's force for a rigid frictionless sphere at x = h/R on a large
// neo-Hookean body with W = mu/2 (I1bar - 3) + kappa/2 (J - 1)^2:
//   F / F_Hertz = 1 + p sqrt(x) + q x                                      docs/theory.md (62)
// A fit to axisymmetric finite-element results, without friction, other hyperelastic laws or
// layers.
struct DeepLaw {
  static constexpr double least_poisson_ratio = 0.27, greatest_poisson_ratio = 0.5;
  static constexpr double deepest = 0.5;  // x
  static constexpr double error =
      0.003;  // relative, of the force: fit, mesh and interpolation in nu together

  double p = 0.0, q = 0.0;

  // F / F_Hertz(h) and dF/dh / (2 E* sqrt(R h)) at x = h/R; 1 for x <= 0, empty for x > `deepest`.
  [[nodiscard]] std::optional<double> force_factor(double x) const;
  [[nodiscard]] std::optional<double> stiffness_factor(double x) const;
};

// For tissue of this Poisson's ratio; empty outside [0.27, 0.5], where no fit exists. p and q are
// natural cubic splines through the six computed ratios, extrapolated above the last, 0.4995. A
// spline through five of them predicts an inner sixth one to 2.5e-4 of the force.
[[nodiscard]] std::optional<DeepLaw> deep_law(double poisson_ratio);

// Contact of a linear elastic half-space with an exact sphere instead of Hertz's paraboloid.
struct TrueSphere {
  double contact_radius = 0.0;  // m, less than R
  double force = 0.0;           // N
};

// At the depth h (m) of a rigid sphere of radius R (m), E* (Pa); zero for h <= 0. Defined for any
// depth, although linear elasticity holds only for h << R; a stays below R.
//                                                       Sneddon 1965, Int. J. Eng. Sci. 3, 47-57
[[nodiscard]] TrueSphere sneddon_sphere(double depth, double radius, double modulus);

}  // namespace palpate::contact
