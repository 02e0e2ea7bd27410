// A sphere pressed in deep against its radius: a fitted factor for neo-Hookean tissue, and
// Sneddon's linear-elastic true sphere.
#pragma once

#include <optional>

namespace palpate::contact {

// The factor on Hertz's force of a rigid frictionless sphere in a deep neo-Hookean body,
// W = mu/2 (I1bar - 3) + kappa/2 (J - 1)^2, at x = h/R:   F / F_Hertz = 1 + p sqrt(x) + q x
// A fit to axisymmetric finite elements. Friction, other hyperelastic laws and thin layers are
// outside.                                                                docs/theory.md (62)
struct DeepLaw {
  static constexpr double least_poisson_ratio = 0.27, greatest_poisson_ratio = 0.5;
  static constexpr double deepest = 0.5;  // x
  static constexpr double error = 0.003;  // of the force: fit, mesh and nu together

  double p = 0.0, q = 0.0;

  // F / F_Hertz(h) and dF/dh / (2 E* sqrt(R h)) at x = h/R; 1 for x <= 0, empty for x > `deepest`.
  [[nodiscard]] std::optional<double> force_factor(double x) const;
  [[nodiscard]] std::optional<double> stiffness_factor(double x) const;
};

// Of a tissue of this ratio. Empty outside [0.27, 0.5]: no fit has been made there. Between the six
// ratios that were computed p and q follow natural cubic splines, which find any inner one of the
// six from the other five to 2.5e-4 of the force; beyond the last, 0.4995, the splines run on.
[[nodiscard]] std::optional<DeepLaw> deep_law(double poisson_ratio);

// The linear elastic half-space under a true sphere instead of Hertz's paraboloid.
struct TrueSphere {
  double contact_radius = 0.0;  // m, less than R
  double force = 0.0;           // N
};

// At the depth h (m) of a rigid sphere of radius R (m), E* (Pa); nothing for h <= 0. Any depth has
// an answer, though linear elasticity means it for h << R only; a stays below R.
//                                                      Sneddon 1965, Int. J. Eng. Sci. 3, 47-57
[[nodiscard]] TrueSphere sneddon_sphere(double depth, double radius, double modulus);

}  // namespace palpate::contact
