// Turns the fitted table of deep presses into one polynomial in sqrt(h) for a place.
#include "contact/depth_ratio.h"

#include <algorithm>
#include <cmath>

namespace palpate::contact {
namespace {

// c_ijm x^(i/2) y^j q^m, for m = 0 to 4.
struct Term {
  std::size_t root, share;  // i and j
  std::array<double, 5> by_ratio;
};
using Terms = std::array<Term, 13>;

// Printed by tests/elasticity/deep_ratio.py --cpp, which fits each to 2350 forces on wide layers.
// They are off by 0.21 % (bonded) and 0.14 % (frictionless) of the force at most.
constexpr Terms bonded{{
    {.root = 1, .share = 0, .by_ratio = {-0.079831, 0.29841, -0.17265, 0.22639, -0.062339}},
    {.root = 2, .share = 0, .by_ratio = {-0.067943, 0.019901, 0.0041225, -0.2089, 0.25109}},
    {.root = 4, .share = 0, .by_ratio = {-0.02353, -0.17356, 0.68964, -0.63712, 0.11773}},
    {.root = 0, .share = 1, .by_ratio = {0.079568, 0.76576, -0.61054, -0.75171, 0.84366}},
    {.root = 1, .share = 1, .by_ratio = {-0.33409, -3.0628, 7.2792, -4.5894, -0.12486}},
    {.root = 2, .share = 1, .by_ratio = {-0.21325, 4.7295, -11.479, 9.2909, -1.6557}},
    {.root = 0, .share = 2, .by_ratio = {-0.50606, 11.581, -27.258, 30.282, -10.765}},
    {.root = 1, .share = 2, .by_ratio = {0.76808, -23.996, 76.271, -88.576, 35.204}},
    {.root = 2, .share = 2, .by_ratio = {1.0489, 1.0946, -37.306, 69.063, -36.258}},
    {.root = 0, .share = 3, .by_ratio = {1.1045, -0.53249, -53.724, 91.279, -47.766}},
    {.root = 1, .share = 3, .by_ratio = {-4.7222, 28.871, 51.414, -174.99, 107.79}},
    {.root = 0, .share = 4, .by_ratio = {0.78047, -5.8351, 56.533, -80.505, 39.629}},
    {.root = 1, .share = 4, .by_ratio = {2.4749, -17.513, -74.347, 195.27, -114.82}},
}};

constexpr Terms frictionless{{
    {.root = 1, .share = 0, .by_ratio = {-0.062797, 0.27175, -0.040186, -0.19333, 0.21672}},
    {.root = 2, .share = 0, .by_ratio = {-0.10722, 0.03217, -0.05961, 0.46295, -0.30623}},
    {.root = 4, .share = 0, .by_ratio = {-0.0020827, -0.04556, 0.17753, -0.3529, 0.18739}},
    {.root = 0, .share = 1, .by_ratio = {-0.023236, 0.672, -0.66563, 0.31323, 0.085632}},
    {.root = 1, .share = 1, .by_ratio = {-0.22624, -1.1291, 1.7242, -2.2777, 1.2846}},
    {.root = 2, .share = 1, .by_ratio = {0.096293, -0.18189, 2.5167, -2.7074, 0.70911}},
    {.root = 0, .share = 2, .by_ratio = {0.86454, -2.2912, 10.902, -5.4857, -1.5291}},
    {.root = 1, .share = 2, .by_ratio = {-0.6901, 7.8041, -28.314, 29.075, -8.7857}},
    {.root = 2, .share = 2, .by_ratio = {-0.63893, 0.7807, -6.9088, 6.8168, -1.3668}},
    {.root = 0, .share = 3, .by_ratio = {-3.2852, 10.284, -37.753, 16.727, 8.0914}},
    {.root = 1, .share = 3, .by_ratio = {4.7054, -26.348, 96.126, -80.38, 11.905}},
    {.root = 0, .share = 4, .by_ratio = {3.3386, -11.972, 41.414, -20.391, -5.951}},
    {.root = 1, .share = 4, .by_ratio = {-4.631, 25.24, -87.324, 63.065, -2.7337}},
}};

constexpr double least_error = 0.004;  // of the terms above and of the finite elements, 0.2 % each
constexpr double side_error = 2.0;     // the largest of the discs, times (a/W)^2 h/W

}  // namespace

std::optional<DepthRatio> depth_ratio(const DeepPress& press) {
  const double nu = press.poisson_ratio;
  const double thin = press.radius / press.thickness;
  if (!(nu >= 0.0 && nu <= 0.5) || !(thin >= 0.0 && thin <= 1.0 / DepthRatio::thinnest))
    return std::nullopt;
  const double q = (1.0 - 2.0 * nu) / (1.0 - nu);

  // With s = sqrt(h/R): sqrt(x) = s and y = (R/t) s^2.
  DepthRatio ratio;
  for (const Term& term : press.base == LayerBase::bonded ? bonded : frictionless) {
    double value = 0.0;
    for (std::size_t m = term.by_ratio.size(); m > 0; --m) value = value * q + term.by_ratio[m - 1];
    for (std::size_t j = 0; j < term.share; ++j) value *= thin;
    ratio.coefficients_[term.root + 2 * term.share - 1] += value;
  }
  ratio.radius_ = press.radius;
  ratio.tissue_share_ = press.tissue_share;
  ratio.last_depth_ =
      std::min(DepthRatio::deepest_x * press.radius, DepthRatio::deepest_y * press.thickness) /
      press.tissue_share;
  ratio.of_side_ =
      side_error * press.radius / (press.half_width * press.half_width * press.half_width);
  return ratio;
}

double DepthRatio::value(double depth) const {
  if (!(depth > 0.0)) return 1.0;
  const double s = std::sqrt(tissue_share_ * std::min(depth, last_depth_) / radius_);
  double sum = 0.0;
  for (std::size_t n = highest; n > 0; --n) sum = (sum + coefficients_[n - 1]) * s;
  return 1.0 + sum;
}

double DepthRatio::error(double depth) const {
  if (!(depth > 0.0)) return 0.0;
  const double known = std::min(depth, last_depth_);
  const double yielded = tissue_share_ * known;
  return least_error + of_side_ * yielded * yielded +
         std::abs(value(known) - 1.0) * (depth - known) / known;
}

double depth_bound(double depth, double effective_radius, double thickness, double poisson_ratio) {
  if (!(depth > 0.0)) return 0.0;
  const double q = (1.0 - 2.0 * poisson_ratio) / (1.0 - poisson_ratio);
  return 0.5 * ((0.1 + 0.3 * q) * std::sqrt(depth / effective_radius) + depth / thickness);
}

}  // namespace palpate::contact
