// Tabulates the layer's force law over chi by Chebyshev polynomials.
#include "contact/layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double layer_chi(double depth, double radius, double thickness) {
  return hertz::contact_radius(depth, radius) / thickness;
}

// The factors, continued to negative chi, have their nearest singularities off the real axis, where
// a is about +-i top layer thicknesses. In t = chi / (top + chi) these are farther from the
// interval: 24 terms are as accurate as 32 terms in chi. t is scaled so that last_chi is at 1.
double LayerLaw::place(double chi) const {
  return (top_ + last_chi_) / last_chi_ * chi / (top_ + chi);
}
double LayerLaw::place_slope(double chi) const {
  return (top_ + last_chi_) / last_chi_ * top_ / ((top_ + chi) * (top_ + chi));
}

LayerLaw::LayerLaw(const Layer& layer) : top_(layer.top()), last_chi_(std::min(3.0, 12.0 * top_)) {
  const std::size_t nodes = layer.below.empty() ? 24 : 40;
  // D > 1/4 even in very thin layers, so that a/H = chi / sqrt(D) stays below 2 last_chi.
  const LayerEquation equation(layer, layer_resolution(2.0 * last_chi_ / top_));
  Series force(nodes), radius(nodes);
  std::array<Series, PressureProfile::terms> pressure;
  pressure.fill(Series(nodes));
  force_ = radius_ = force;
  pressure_ = pressure;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double stretched = chebyshev_node(i, nodes);
    const double chi = top_ * stretched / ((top_ + last_chi_) / last_chi_ - stretched);
    const LayerSolution solution = equation.solve_chi(chi);
    force[i] = (solution.force_factor() - 1.0) / chi;
    radius[i] = (solution.radius_factor() - 1.0) / chi;
    for (std::size_t k = 0; k < pressure.size(); ++k)
      pressure[k][i] = (solution.pressure.coefficients[k] - (k == 0 ? 1.5 : 0.0)) / chi;
  }
  chebyshev_fit(force, force_);
  chebyshev_fit(radius, radius_);
  for (std::size_t k = 0; k < pressure.size(); ++k) chebyshev_fit(pressure[k], pressure_[k]);
}

LayerLaw::Factor LayerLaw::factor(double chi) const {
  if (!known(chi)) return {.value = unknown, .slope = unknown};
  const ChebyshevSum sum = chebyshev_sum(force_, place(chi));
  return {.value = 1.0 + chi * sum.value, .slope = sum.value + chi * sum.slope * place_slope(chi)};
}

double LayerLaw::force_factor(double chi) const { return factor(chi).value; }

double LayerLaw::force_slope(double chi) const { return factor(chi).slope; }

double LayerLaw::stiffness_factor(double chi) const {
  // F ~ h^(3/2) f(chi) and chi ~ h^(1/2): dF/dh = 2 E* sqrt(R h) (f + chi/3 df/dchi)
  const Factor f = factor(chi);
  return f.value + chi / 3.0 * f.slope;
}

double LayerLaw::radius_factor(double chi) const {
  return known(chi) ? 1.0 + chi * chebyshev_sum(radius_, place(chi)).value : unknown;
}

PressureProfile LayerLaw::pressure(double chi) const {
  PressureProfile profile;
  if (!known(chi)) {
    profile.coefficients.fill(unknown);
    return profile;
  }
  for (std::size_t k = 0; k < pressure_.size(); ++k)
    profile.coefficients[k] = chi * chebyshev_sum(pressure_[k], place(chi)).value;
  profile.coefficients[0] += 1.5;
  return profile;
}

std::optional<double> LayerLaw::chi(double load) const {
  if (load <= 0.0) return 0.0;
  if (!(load <= last_chi_ * last_chi_ * last_chi_ * force_factor(last_chi_))) return std::nullopt;
  // If f >= 1, chi is at most load^(1/3), hence below the larger of load^(1/4) and load^(1/2), and
  // Newton's method converges from above on the convex chi^3 f(chi) - load. Over softer layers chi
  // may be larger and the function not convex; then bisection replaces steps out of the bracket.
  const double root = std::sqrt(load);
  const double above = std::max(root, std::sqrt(root));
  double low = 0.0;
  double high = last_chi_;
  double chi = std::min(last_chi_, above);
  for (int pass = 0; pass < 60; ++pass) {
    const Factor f = factor(chi);
    const double excess = chi * chi * chi * f.value - load;
    (excess < 0.0 ? low : high) = chi;
    const double change = excess / (chi * chi * (3.0 * f.value + chi * f.slope));
    chi -= change;
    if (std::abs(change) <= 1e-15 * chi) break;
    if (!(chi > low && chi < high)) chi = 0.5 * (low + high);
  }
  return chi;
}

double LayerContact::last_depth() const {
  const double radius_there = law.last_chi() * thickness;
  return radius_there * radius_there / radius;
}

double LayerContact::force(double depth) const {
  return hertz::force(depth, radius, modulus) *
         law.force_factor(layer_chi(depth, radius, thickness));
}

double LayerContact::stiffness(double depth) const {
  return hertz::stiffness(depth, radius, modulus) *
         law.stiffness_factor(layer_chi(depth, radius, thickness));
}

std::optional<double> LayerContact::depth(double force) const {
  // h = (chi H)^2 / R
  const double unit = 4.0 / 3.0 * modulus * thickness * thickness * thickness / radius;
  const auto chi = law.chi(force / unit);
  if (!chi) return std::nullopt;
  return *chi * *chi * thickness * thickness / radius;
}

double LayerContact::contact_radius(double depth) const {
  return hertz::contact_radius(depth, radius) *
         law.radius_factor(layer_chi(depth, radius, thickness));
}

double LayerContact::pressure(double distance, double depth) const {
  if (depth <= 0.0) return 0.0;
  const double a = contact_radius(depth);
  return force(depth) / (std::numbers::pi * a * a) *
         law.pressure(layer_chi(depth, radius, thickness)).at(distance / a);
}

}  // namespace palpate::contact
