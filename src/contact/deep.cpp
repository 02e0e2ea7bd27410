// Interpolates the fitted factors between Poisson's ratios, and inverts Sneddon's depth.
#include "contact/deep.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

using Six = std::array<double, 6>;
constexpr Six ratios{0.27, 0.33, 0.40, 0.45, 0.49, 0.4995};
constexpr Six fitted_p{0.0906, 0.0628, 0.0261, -0.0098, -0.0495, -0.0602};
constexpr Six fitted_q{-0.0687, -0.0841, -0.1036, -0.1129, -0.1130, -0.1124};

// The second derivatives of the natural cubic spline through `values`:
//   h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = 6 (d_i - d_(i-1)),   m_0 = m_5 = 0
// with h_i the distances and d_i the slopes of the chords.
Six spline_bends(const Six& values) {
  const auto width = [](std::size_t i) { return ratios[i + 1] - ratios[i]; };
  const auto chord = [&](std::size_t i) { return (values[i + 1] - values[i]) / width(i); };
  Six bends{}, diagonal{};
  for (std::size_t i = 1; i + 1 < ratios.size(); ++i) {
    diagonal[i] = 2.0 * (width(i - 1) + width(i));
    bends[i] = 6.0 * (chord(i) - chord(i - 1));
    if (i == 1) continue;
    const double factor = width(i - 1) / diagonal[i - 1];
    diagonal[i] -= factor * width(i - 1);
    bends[i] -= factor * bends[i - 1];
  }
  for (std::size_t i = ratios.size() - 2; i > 0; --i)
    bends[i] = (bends[i] - width(i) * bends[i + 1]) / diagonal[i];
  return bends;
}

double interpolate(const Six& values, double ratio) {
  const Six bends = spline_bends(values);
  std::size_t i = 0;
  while (i + 2 < ratios.size() && ratio > ratios[i + 1]) ++i;
  const double width = ratios[i + 1] - ratios[i];
  const double b = (ratio - ratios[i]) / width;
  const double a = 1.0 - b;
  return a * values[i] + b * values[i + 1] +
         ((a * a - 1.0) * a * bends[i] + (b * b - 1.0) * b * bends[i + 1]) * width * width / 6.0;
}

}  // namespace

std::optional<double> DeepLaw::force_factor(double x) const {
  if (x <= 0.0) return 1.0;
  if (!(x <= deepest)) return std::nullopt;
  return 1.0 + p * std::sqrt(x) + q * x;
}

std::optional<double> DeepLaw::stiffness_factor(double x) const {
  if (x <= 0.0) return 1.0;
  if (!(x <= deepest)) return std::nullopt;
  // d/dh of h^(3/2) (1 + p sqrt(x) + q x), over d/dh of h^(3/2)
  return 1.0 + 4.0 / 3.0 * p * std::sqrt(x) + 5.0 / 3.0 * q * x;
}

std::optional<DeepLaw> deep_law(double poisson_ratio) {
  if (!(poisson_ratio >= DeepLaw::least_poisson_ratio &&
        poisson_ratio <= DeepLaw::greatest_poisson_ratio))
    return std::nullopt;
  return DeepLaw{.p = interpolate(fitted_p, poisson_ratio),
                 .q = interpolate(fitted_q, poisson_ratio)};
}

TrueSphere sneddon_sphere(double depth, double radius, double modulus) {
  if (depth <= 0.0) return {};
  const double x = depth / radius;
  // h = (a/2) ln((R + a)/(R - a)); with y = atanh(a/R) this is x = y tanh(y). Since tanh(y) >= y/(1
  // + y) the root is below the start value. This runs only at set-up, so tanh is allowed.
  double y = 0.5 * (x + std::sqrt(x * (x + 4.0)));
  for (int pass = 0; pass < 60; ++pass) {
    const double t = std::tanh(y);
    const double change = (y * t - x) / (t + y * (1.0 - t * t));
    y -= change;
    if (std::abs(change) <= 1e-15 * y) break;
  }
  const double t = std::tanh(y);
  // F = E* [(a^2 + R^2)/2 ln((R + a)/(R - a)) - a R]
  if (x > 0.01)
    return {.contact_radius = radius * t,
            .force = modulus * radius * radius * ((t * t + 1.0) * y - t)};
  // For small x the terms cancel, so a series is used; its error is 3e-5 x^5.
  const double factor =
      1.0 + x * (-1.0 / 10.0 + x * (-1.0 / 840.0 + x * (11.0 / 15120.0 + x * 1357.0 / 6652800.0)));
  return {.contact_radius = radius * t, .force = factor * hertz::force(depth, radius, modulus)};
}

}  // namespace palpate::contact
