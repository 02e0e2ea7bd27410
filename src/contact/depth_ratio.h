// The force of a deep press in finite strain, as a factor of the force in linear elasticity.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "contact/layer_integral.h"

namespace palpate::contact {

// Under the contact: one, bonded layers, or one with a ball of another.
enum class Tissues { one, layers, inclusion };

// What the factor depends on besides the depth. Lengths in m.
struct DeepPress {
  double radius = 0.0;            // R of the rigid sphere
  double effective_radius = 0.0;  // R_e of the contact: R on a flat body, less on a convex one
  double thickness = 0.0;         // t under the contact; infinite where there is no base
  double poisson_ratio = 0.0;     // of the tissue at the contact
  LayerBase base = LayerBase::bonded;
  // The share of the depth by which the tissue yields; the rest is that of an elastic finger.
  double tissue_share = 1.0;
  // Of a stack of layers: the thickness t_1 of the top one, the length L over which it bends on the
  // second one, and the linear force divided by Hertz's force on the tissue of the top layer alone.
  double skin = std::numeric_limits<double>::infinity();
  double bending_length = std::numeric_limits<double>::infinity();
  double force_over_hertz = 1.0;
  // W to the sides: the mean of 1/W^3 over all directions is that of this distance.
  double side_distance = std::numeric_limits<double>::infinity();
  // What affects the stated error only:
  double half_width = std::numeric_limits<double>::infinity();  // W to the nearest side
  Tissues tissues = Tissues::one;
};

// F / F_linear at the depth h. F is the force of a rigid frictionless sphere on neo-Hookean tissue
// with W = mu/2 (I1bar - 3) + kappa/2 (J - 1)^2, and F_linear that of linear elasticity where the
// sphere is a paraboloid (`hertz`, `layer`, `coupled_springs`). A polynomial in sqrt(h) that is 1
// at h = 0 and needs nothing but + * / and sqrt, so that a step may evaluate it.
//   1 + sum c_ijm x^(i/2) y^j q^m + (a/W)^2 h/W (d_6 + d_7 q)   on flat bodies
//                                 + K y (d_1 y + d_2 q)     where K >= 0
//                                 + K y^2 (d_3 + d_4 y)     where K < 0
//     + g (d_5 y + d_8 q sqrt(x) + d_9 ((h / (h + t_1))^2 - (h / (h + L))^2))  of a stiff skin
//   x = R_e h / R^2,  a^2 = R_e h,  y = h / t,  q = (1 - 2 nu) / (1 - nu),  K = R / R_e - 1,
//   g = 1 - force_over_hertz, 0 where that is negative
// On wide layers this is the finite elements to 0.2 %.            tests/elasticity/deep_ratio.py
class DepthRatio {
 public:
  static constexpr double deepest_x = 0.8, deepest_y = 0.5;
  static constexpr double thinnest = 0.3;  // t / R of the thinnest layer that was computed
  static constexpr double least_curved = -0.5, most_curved = 0.61;  // K; fitted from -0.49 on

  // Where the formula ends, m: at `deepest_x` or `deepest_y`, whichever comes first. Beyond the
  // latter, bonded layers with nu from 0.45 on fold.
  [[nodiscard]] double last_depth() const { return last_depth_; }

  // The factor; 1 for h <= 0, and beyond last_depth() that of last_depth().
  [[nodiscard]] double value(double depth) const;

  // The relative error of the factor, without that of the linear force. On random bodies that had
  // no part in choosing its constants it covers all errors of flat and convex ones of one tissue,
  // and 98 % of those of stacks of layers; on hollow ones both together cover 98 % of 200 presses.
  //   e = 0.004 + 0.15 (a/W)^2 + 0.056 |K| + 0.21 y + 0.056 g sqrt(x) (layers)
  //       + 0.073 x (inclusion) + 2.5 |K| y^(3/2) (hollow)
  // with 0.25 (a/W)^2 where a side is nearer than the 1.8 R that were computed.
  // The term of hollow bodies is what the linear force of a mesh adds where the sphere conforms.
  // Beyond last_depth() the factor's distance from 1 is added as often as it fits into the excess.
  [[nodiscard]] double error(double depth) const;

 private:
  friend std::optional<DepthRatio> depth_ratio(const DeepPress& press);
  static constexpr std::size_t highest = 9;     // power of sqrt(h)
  std::array<double, highest> coefficients_{};  // of s, s^2 ...; s = sqrt(h/R)
  double radius_ = 1.0, last_depth_ = 0.0, tissue_share_ = 1.0;
  double soft_ = 0.0, skin_ = 1.0, bending_length_ = 1.0;  // g, t_1 and L
  // 1, 1/m^(1/2), 1/m and 1/m^(3/2)
  double least_error_ = 0.0, error_of_skin_ = 0.0, error_by_depth_ = 0.0, error_of_hollow_ = 0.0;
};

// For one place and sphere. Empty where nothing was computed: nu outside [0, 1/2], tissue thinner
// than 0.3 R, a body whose curvature is outside [-0.5, 0.61] / R, or no width.
[[nodiscard]] std::optional<DepthRatio> depth_ratio(const DeepPress& press);

// One of the bonded tissues under the contact, from the top.
struct Stratum {
  double thickness = 0.0;      // m
  double young_modulus = 0.0;  // Pa
  double poisson_ratio = 0.0;  // less than 1/2
};

// The `thickness` (m) that stands for several layers: the mean of 1/t_k, weighted with the squares
// of shares s_k of the compliance, which are less unequal than the compliances themselves. The
// ratio of the top layer goes with it. Chosen on random stacks of two and three layers.
//   1/t = sum s_k^2 / t_k,   s_k = (t_k / M_k^0.7) / sum (t_k / M_k^0.7),
//   M = E (1 - nu) / ((1 + nu) (1 - 2 nu))
[[nodiscard]] double effective_thickness(std::span<const Stratum> strata);

// The length L (m) over which the first of at least two strata bends on the second, with the plane
// moduli E* = E / (1 - nu^2):  L = t_1 (E*_1/E*_2)^(1/3)
[[nodiscard]] double bending_length(std::span<const Stratum> strata);

}  // namespace palpate::contact
