// The force of a deep press on wide flat tissue in finite strain, as a factor of the force in
// linear elasticity.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "contact/layer.h"

namespace palpate::contact {

// What the factor depends on besides the depth, on flat tissue of one kind. Lengths in m.
struct DeepPress {
  double radius = 0.0;         // R of the rigid sphere
  double thickness = 0.0;      // t; infinite where there is no base
  double poisson_ratio = 0.0;  // of the tissue
  LayerBase base = LayerBase::bonded;
  // The share of the depth by which the tissue yields; the rest is that of an elastic finger.
  double tissue_share = 1.0;
  double half_width = std::numeric_limits<double>::infinity();  // W to the nearest side
};

// F / F_linear at the depth h. F is the force of a rigid frictionless sphere on neo-Hookean tissue
// with W = mu/2 (I1bar - 3) + kappa/2 (J - 1)^2, and F_linear that of linear elasticity where the
// sphere is a paraboloid (`hertz`, `layer`, `coupled_springs`). A polynomial in sqrt(h) that is 1
// at h = 0 and needs nothing but + * / and sqrt, so that a step may evaluate it.
//   1 + sum c_ijm x^(i/2) y^j q^m,   x = h / R,  y = h / t,  q = (1 - 2 nu) / (1 - nu)
// On wide layers this is the finite elements to 0.2 %.            tests/elasticity/deep_ratio.py
class DepthRatio {
 public:
  static constexpr double deepest_x = 0.8, deepest_y = 0.5;
  static constexpr double thinnest = 0.3;  // t / R of the thinnest layer that was computed

  // Where the formula ends, m: at `deepest_x` or `deepest_y`, whichever comes first. Beyond the
  // latter, bonded layers with nu from 0.45 on fold.
  [[nodiscard]] double last_depth() const { return last_depth_; }

  // The factor; 1 for h <= 0, and beyond last_depth() that of last_depth().
  [[nodiscard]] double value(double depth) const;

  // The relative error of the factor, without that of the linear force: 0.4 % by formula and finite
  // elements, and what the nearest side changes, which is at most 2 (a/W)^2 h/W on the discs that
  // were computed, and half of it on most. Beyond last_depth() the factor's distance from 1 is
  // added as often as it fits into the excess.
  [[nodiscard]] double error(double depth) const;

 private:
  friend std::optional<DepthRatio> depth_ratio(const DeepPress& press);
  static constexpr std::size_t highest = 9;     // power of sqrt(h)
  std::array<double, highest> coefficients_{};  // of s, s^2 ...; s = sqrt(h/R)
  double radius_ = 1.0, last_depth_ = 0.0, tissue_share_ = 1.0;
  double of_side_ = 0.0;  // 1/m^2
};

// For one sphere. Empty where nothing was computed: nu outside [0, 1/2], or tissue thinner than
// 0.3 R.
[[nodiscard]] std::optional<DepthRatio> depth_ratio(const DeepPress& press);

// By how much large strains change the force of a press where there is no table, a fraction of it:
//   ((0.1 + 0.3 q) sqrt(h/R_e) + h/t) / 2
// with the effective radius R_e of the contact, the thickness t of the tissue, or of the softest
// layer under the contact, and the smallest nu. A bound by count: of the 1098 axisymmetric presses
// of tests/elasticity/random_bodies.csv (discs, domes, hollow discs, stacks and balls, to h/R =
// 0.8) all but 4 change by less.                        tests/elasticity/deep_ratio.py
[[nodiscard]] double depth_bound(double depth, double effective_radius, double thickness,
                                 double poisson_ratio);

}  // namespace palpate::contact
