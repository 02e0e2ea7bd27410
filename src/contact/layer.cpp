// Tabulates the layer's force law over chi by Chebyshev polynomials.
#include "contact/layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/numerics.h"
#include "contact/hertz.h"

namespace palpate::contact {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double layer_chi(double depth, double radius, double thickness) {
  return hertz::contact_radius(depth, radius) / thickness;
}

// The factors, continued to negative chi, have their nearest singularities off the real axis, where
// a is about +-i top layer thicknesses. In t = x / (top + x), x = chi or a/H, these are farther
// from the interval: 24 terms are as accurate as 32 terms in chi. t is scaled so that `last` is
// at 1.
double LayerLaw::Scale::place(double x) const { return (top + last) / last * x / (top + x); }
double LayerLaw::Scale::slope(double x) const {
  return (top + last) / last * top / ((top + x) * (top + x));
}
double LayerLaw::Scale::value(double place) const {
  return top * place / ((top + last) / last - place);
}

// D > 1/4 even in very thin layers, so that a/H = chi / sqrt(D) stays below 2 last_chi.
LayerTable::LayerTable(const Layer& layer)
    : top_(layer.top()),
      last_chi_(std::min(3.0, 12.0 * top_)),
      terms_(layer.below.empty() ? 24 : 40) {
  const LayerLaw::Scale scale{top_, 2.0 * last_chi_};
  const std::size_t nodes = terms_ + 4;  // the interval is longer
  // The ratios decrease; after every halving a coarser resolution is sufficient.
  std::optional<LayerEquation> equation;
  double greatest = 0.0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double ratio = scale.value(chebyshev_node(i, nodes));
    if (!equation || ratio < 0.5 * greatest) {
      greatest = ratio;
      equation.emplace(layer, layer_resolution(greatest / top_));
    }
    ratios_.push_back(ratio);
    systems_.push_back(equation->system(ratio, LayerEquation::Wanted::pressure));
  }
}

LayerLaw::LayerLaw(const Layer& layer) : LayerLaw(LayerTable(layer), layer.share) {}

// First the depth, the force and the pressure over a/H, then the factors over chi.
LayerLaw::LayerLaw(const LayerTable& table, double share) : scale_{table.top_, table.last_chi_} {
  constexpr std::size_t profile = PressureProfile::terms;
  const std::size_t nodes = table.ratios_.size();
  Series depth(nodes), force(nodes);
  std::array<Series, profile> pressure;
  pressure.fill(Series(nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    const LayerSolution solution = table.systems_[i].solve(share);
    depth[i] = (solution.depth - 1.0) / solution.ratio;
    force[i] = (solution.force - 1.0) / solution.ratio;
    for (std::size_t k = 0; k < profile; ++k)
      pressure[k][i] = (solution.pressure.coefficients[k] - (k == 0 ? 1.5 : 0.0)) / solution.ratio;
  }
  const auto fitted = [](const ChebyshevFit& fit, const Series& values) {
    Series series(values.size());
    fit(values, series);
    return series;
  };
  const ChebyshevFit over_ratio(nodes), over_chi(table.terms_);
  depth = fitted(over_ratio, depth);
  force = fitted(over_ratio, force);
  for (Series& one : pressure) one = fitted(over_ratio, one);

  const Scale of_ratio{scale_.top, 2.0 * scale_.last};
  Series force_factor(table.terms_), radius_factor(table.terms_);
  std::array<Series, profile> pressures;
  pressures.fill(Series(table.terms_));
  for (std::size_t i = 0; i < table.terms_; ++i) {
    const double chi = scale_.value(chebyshev_node(i, table.terms_));
    // chi = a/H sqrt(D), as in LayerEquation::force_factor().
    const double ratio = numerics::root(chi, {0.0, of_ratio.last}, [&](double trial) {
      const ChebyshevSum sum = chebyshev_sum(depth, of_ratio.place(trial));
      const double root = std::sqrt(1.0 + trial * sum.value);
      return numerics::Tangent{
          trial * root - chi,
          root + 0.5 * trial / root * (sum.value + trial * sum.slope * of_ratio.slope(trial))};
    });
    const double at = of_ratio.place(ratio);
    const double deep = 1.0 + ratio * chebyshev_value(depth, at);  // D
    const double load = 1.0 + ratio * chebyshev_value(force, at);
    force_factor[i] = (load / (deep * std::sqrt(deep)) - 1.0) / chi;
    radius_factor[i] = (1.0 / std::sqrt(deep) - 1.0) / chi;
    for (std::size_t k = 0; k < profile; ++k)
      pressures[k][i] = ratio / chi * chebyshev_value(pressure[k], at);
  }
  force_ = fitted(over_chi, force_factor);
  radius_ = fitted(over_chi, radius_factor);
  for (std::size_t k = 0; k < profile; ++k) pressure_[k] = fitted(over_chi, pressures[k]);
}

LayerLaw::Factor LayerLaw::factor(double chi) const {
  if (!known(chi)) return {.value = unknown, .slope = unknown};
  const ChebyshevSum sum = chebyshev_sum(force_, scale_.place(chi));
  return {.value = 1.0 + chi * sum.value, .slope = sum.value + chi * sum.slope * scale_.slope(chi)};
}

double LayerLaw::force_factor(double chi) const { return factor(chi).value; }

double LayerLaw::stiffness_factor(double chi) const {
  // F ~ h^(3/2) f(chi) and chi ~ h^(1/2): dF/dh = 2 E* sqrt(R h) (f + chi/3 df/dchi)
  const Factor f = factor(chi);
  return f.value + chi / 3.0 * f.slope;
}

double LayerLaw::radius_factor(double chi) const {
  return known(chi) ? 1.0 + chi * chebyshev_value(radius_, scale_.place(chi)) : unknown;
}

PressureProfile LayerLaw::pressure(double chi) const {
  PressureProfile profile;
  if (!known(chi)) {
    profile.coefficients.fill(unknown);
    return profile;
  }
  for (std::size_t k = 0; k < pressure_.size(); ++k)
    profile.coefficients[k] = chi * chebyshev_value(pressure_[k], scale_.place(chi));
  profile.coefficients[0] += 1.5;
  return profile;
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

double LayerContact::contact_radius(double depth) const {
  return hertz::contact_radius(depth, radius) *
         law.radius_factor(layer_chi(depth, radius, thickness));
}

}  // namespace palpate::contact
