// Searches over the logarithms of the times (they stay positive), from the best times of a grid.
#include "fit/prony.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/index.h"
#include "fit/ceres_fit.h"
#include "fit/settle.h"

namespace palpate::fit {
namespace {

struct Points {
  std::vector<double> x;   // minus x_origin, divided by x_scale
  std::vector<double> y;   // divided by y_scale
  double x_scale = 1.0;    // range of x
  double y_scale = 1.0;    // largest |y|
  double least_gap = 1.0;  // smallest distance of two scaled x
};

Points usable(std::span<const double> x, std::span<const double> y, int needed, Fit& fit) {
  Points points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    points.x.push_back(x[i] - fit.x_origin);
    points.y.push_back(y[i]);
    fit.range_low = std::fmin(fit.range_low, x[i]);
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  fit.n = static_cast<int>(points.x.size());
  fit.left_out = static_cast<int>(x.size()) - fit.n;
  if (fit.n < needed)
    throw InputError({}, "the model `" + fit.name + "` needs at least " + std::to_string(needed) +
                             " points for this number of terms, and " + std::to_string(fit.n) +
                             (fit.n == 1 ? " is" : " are") +
                             " usable; record more points, or give fewer `--terms`");
  if (fit.range_low == fit.range_high)
    throw InputError({}, "all points have the same x; give a curve over time");
  points.x_scale = fit.range_high - fit.range_low;
  double largest = 0.0;
  for (const double each : points.y) largest = std::max(largest, std::abs(each));
  points.y_scale = largest > 0.0 ? largest : 1.0;
  for (double& each : points.x) each /= points.x_scale;
  for (double& each : points.y) each /= points.y_scale;
  std::vector<double> sorted = points.x;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] > sorted[i - 1])
      points.least_gap = std::min(points.least_gap, sorted[i] - sorted[i - 1]);
  return points;
}

// phi_k(x) and d phi_k / d ln tau, docs/theory.md (92).
struct Term {
  double value, slope;
};
Term term(PronySeries::Kind kind, double x, double tau) {
  // d e^(-x/tau) / d ln tau = x/tau e^(-x/tau)
  const double left = std::exp(-x / tau);
  const double slope = x / tau * left;
  if (kind == PronySeries::Kind::relaxation) return {left, slope};
  return {-std::expm1(-x / tau), -slope};
}

// The linear fit for given times: constant and factors y_k, with its sum of squares.
struct Linear {
  Eigen::VectorXd heights;
  double squares = std::numeric_limits<double>::infinity();
};
Linear linear(const Points& points, PronySeries::Kind kind, std::span<const double> times) {
  // At most 400 points suffice to choose the start.
  const std::size_t stride = 1 + points.x.size() / 400;
  const auto rows = static_cast<Eigen::Index>((points.x.size() + stride - 1) / stride);
  Eigen::MatrixXd matrix(rows, static_cast<Eigen::Index>(times.size()) + 1);
  Eigen::VectorXd target(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t from = as_index(i) * stride;
    matrix(i, 0) = 1.0;
    target(i) = points.y[from];
    for (std::size_t k = 0; k < times.size(); ++k)
      matrix(i, static_cast<Eigen::Index>(k) + 1) = term(kind, points.x[from], times[k]).value;
  }
  Linear found;
  if (!matrix.allFinite()) return found;
  found.heights = matrix.colPivHouseholderQr().solve(target);
  if (!found.heights.allFinite()) return found;
  found.squares = (matrix * found.heights - target).squaredNorm();
  return found;
}

// Geometrically spaced times, from the smallest distance of two points to three times the range.
std::vector<double> grid(const Points& points) {
  constexpr int count = 12;
  const double low = std::log(std::max(points.least_gap, 1e-5));
  const double high = std::log(3.0);
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(std::exp(low + (high - low) * i / (count - 1)));
  return times;
}

// The best combination of `terms` different times of the grid. Returns the unknowns of the search:
// the constant, then y_k and ln tau_k of each term.
std::vector<double> start_of(const Points& points, const PronySeries& series) {
  const std::vector<double> times = grid(points);
  std::vector<char> chosen(times.size(), 0);
  std::fill_n(chosen.begin(), series.terms, 1);
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  do {
    std::vector<double> some;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (chosen[i] != 0) some.push_back(times[i]);
    const Linear found = linear(points, series.kind, some);
    if (!(found.squares < least)) continue;
    least = found.squares;
    best = {found.heights(0)};
    for (std::size_t k = 0; k < some.size(); ++k) {
      best.push_back(found.heights(static_cast<Eigen::Index>(k) + 1));
      best.push_back(std::log(some[k]));
    }
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

// Sorts the terms by increasing tau; the search may have changed their order.
void sort_terms(Minimum& minimum) {
  const std::size_t count = minimum.parameters.size();
  std::vector<std::size_t> terms(count / 2);
  std::iota(terms.begin(), terms.end(), std::size_t{0});
  std::stable_sort(terms.begin(), terms.end(), [&](std::size_t a, std::size_t b) {
    return minimum.parameters[2 * a + 2] < minimum.parameters[2 * b + 2];
  });
  std::vector<std::size_t> from{0};
  for (const std::size_t k : terms) {
    from.push_back(2 * k + 1);
    from.push_back(2 * k + 2);
  }
  const Minimum before = minimum;
  for (std::size_t i = 0; i < count; ++i) {
    minimum.parameters[i] = before.parameters[from[i]];
    if (before.inverse_normal.empty()) continue;
    for (std::size_t j = 0; j < count; ++j)
      minimum.inverse_normal[i * count + j] = before.inverse_normal[from[i] * count + from[j]];
  }
  for (std::size_t row = 0; row < before.jacobian.size(); row += count)
    for (std::size_t i = 0; i < count; ++i)
      minimum.jacobian[row + i] = before.jacobian[row + from[i]];
}

// Converts ln tau to tau, with d tau = tau d ln tau for the errors.
void times_of(Minimum& minimum) {
  const std::size_t count = minimum.parameters.size();
  for (std::size_t i = 2; i < count; i += 2) {
    const double tau = std::exp(minimum.parameters[i]);
    minimum.parameters[i] = tau;
    for (std::size_t j = 0; j < count && !minimum.inverse_normal.empty(); ++j) {
      minimum.inverse_normal[i * count + j] *= tau;
      minimum.inverse_normal[j * count + i] *= tau;
    }
    for (std::size_t at = i; at < minimum.jacobian.size(); at += count) minimum.jacobian[at] /= tau;
  }
}

}  // namespace

Fit fit_prony(std::span<const double> x, std::span<const double> y, const PronySeries& series,
              const Options& options) {
  assert(x.size() == y.size() && series.terms >= 1 && series.terms <= 5);
  const bool relaxation = series.kind == PronySeries::Kind::relaxation;
  Fit fit;
  fit.name = relaxation ? "prony" : "prony_creep";
  fit.law =
      relaxation ? "y = y_inf + sum y_k e^(-x/tau_k)" : "y = y_0 + sum y_k (1 - e^(-x/tau_k))";
  fit.x_origin = options.x_origin;
  fit.parameters.push_back({.name = relaxation ? "y_inf" : "y_0", .unit = options.y_unit});
  for (int k = 1; k <= series.terms; ++k) {
    fit.parameters.push_back({.name = "y_" + std::to_string(k), .unit = options.y_unit});
    fit.parameters.push_back({.name = "tau_" + std::to_string(k), .unit = options.x_unit});
  }
  const Points points = usable(x, y, 2 * series.terms + 2, fit);
  const std::vector<double> start = start_of(points, series);
  if (start.empty()) return fit;

  const std::size_t count = start.size();
  const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                            std::span<double> slopes) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      double sum = p[0];
      if (!slopes.empty()) slopes[i * count] = 1.0;
      for (std::size_t k = 1; k < count; k += 2) {
        const Term one = term(series.kind, points.x[i], std::exp(p[k + 1]));
        sum += p[k] * one.value;
        if (slopes.empty()) continue;
        slopes[i * count + k] = one.value;
        slopes[i * count + k + 1] = p[k] * one.slope;
      }
      values[i] = sum;
    }
    return true;
  };
  Minimum minimum = minimise(points.y, curve, start, options.max_iterations);
  std::vector<double> scale(count, points.y_scale);
  for (std::size_t i = 2; i < count; i += 2) scale[i] = points.x_scale;
  for (std::size_t i = 0; i < count; ++i)
    fit.parameters[i].initial = (i >= 2 && i % 2 == 0 ? std::exp(start[i]) : start[i]) * scale[i];
  if (minimum.status != Minimum::Status::failed) {
    sort_terms(minimum);
    times_of(minimum);
  }
  settle(fit, minimum, {points.y, points.y_scale, scale, options.residuals});
  return fit;
}

}  // namespace palpate::fit
