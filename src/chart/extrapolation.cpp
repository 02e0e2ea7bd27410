// The observed order, then the extrapolation (docs/theory.md [extrapolation]).
#include "chart/extrapolation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/numerics.h"

namespace palpate::chart {
namespace {

constexpr double least_order = 0.5;
constexpr double most_order = 3.0;

// (h1^p - h2^p) / (h2^p - h3^p), which grows with p.
double ratio_of_changes(std::span<const double> h, double p) {
  return (std::pow(h[0] / h[1], p) - 1.0) / (1.0 - std::pow(h[2] / h[1], p));
}

// The p with this ratio of changes, not below `least_order`.
double observed_order(std::span<const double> h, double ratio) {
  return numerics::root({least_order, most_order},
                        [&](double p) { return ratio_of_changes(h, p) - ratio; })
      .middle();
}

}  // namespace

Extrapolated extrapolate(std::span<const double> spacings, std::span<const double> values) {
  assert(spacings.size() == values.size() && !values.empty());
  const double finest = values.back();
  if (values.size() == 1) return {finest, std::numeric_limits<double>::infinity(), 0.0};
  const std::size_t count = std::min<std::size_t>(3, values.size());
  const auto h = spacings.last(count);
  const auto f = values.last(count);
  const double last_change = f[count - 1] - f[count - 2];
  Extrapolated result{.value = finest, .order = 1.0};
  if (count == 3) {
    const double change = f[1] - f[0];
    if (last_change == 0.0 && change == 0.0) return {finest, 0.0, 0.0};
    const bool settles =
        change * last_change > 0.0 && change / last_change <= ratio_of_changes(h, most_order);
    if (!settles) {
      const auto [low, high] = std::minmax({f[0], f[1], f[2]});
      return {finest, high - low, 0.0};
    }
    result.order = observed_order(h, change / last_change);
  }
  // value + C h^p: (remaining change) / (last change) = 1 / ((h_2 / h_3)^p - 1)
  const double rest = last_change / (std::pow(h[count - 2] / h[count - 1], result.order) - 1.0);
  result.value += rest;
  result.error = std::max(std::abs(rest), 0.5 * std::abs(last_change));
  if (count == 2) result.error *= 2.0;
  return result;
}

}  // namespace palpate::chart
