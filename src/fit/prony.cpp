// Searches over the logarithms of the times (they stay positive), from the best times of a grid.
#include "fit/prony.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/dense.h"
#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "fit/ceres_fit.h"

namespace palpate::fit {
namespace {

struct Term {
  double value, slope;
};

// e^(-t/tau), and d/d ln tau = t/tau e^(-t/tau)
Term after_step(double t, double tau) {
  const double left = std::exp(-t / tau);
  return {left, t / tau * left};
}

Term after_ramp(double t, double tau, double ramp) {
  if (t <= 0.0) return {0.0, 0.0};
  const double since_start = std::exp(-t / tau);
  if (t < ramp) {
    const double value = -tau / ramp * std::expm1(-t / tau);
    return {value, value - t / ramp * since_start};
  }
  const double since_end = std::exp(-(t - ramp) / tau);
  // since_end - since_start = since_end (1 - e^(-ramp/tau)), without cancellation
  const double value = -tau / ramp * since_end * std::expm1(-ramp / tau);
  return {value, value + (t - ramp) / ramp * since_end - t / ramp * since_start};
}

// Least squares over the columns that are free; the others are 0.
Eigen::VectorXd over_free(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                          const std::vector<char>& free) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    if (free[static_cast<std::size_t>(i)] != 0) columns.push_back(i);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(a.cols());
  all(columns) = dense::least_squares(a(Eigen::all, columns), b);
  return all;
}

struct Points {
  std::vector<double> x;   // minus x_origin, divided by x_scale
  std::vector<double> y;   // divided by y_scale
  double x_scale = 1.0;    // range of x
  double y_scale = 1.0;    // largest |y|
  double least_gap = 1.0;  // smallest distance of two scaled x
  LoadingHistory history;  // times divided by x_scale
};

// Divides the history by its largest value, and refuses times that do not ascend.
void scale_history(Points& points) {
  std::vector<double>& samples = points.history.samples;
  if (samples.empty()) return;
  double largest = 0.0;
  for (const double each : samples)
    if (std::abs(each) > std::abs(largest)) largest = each;
  if (largest == 0.0)
    throw InputError({}, "the loading history is 0 at every point; name another `--history`");
  for (double& each : samples) each /= largest;
  if (!std::ranges::is_sorted(points.x))
    throw InputError({},
                     "the times do not ascend, as a loading history wants; give a part of the "
                     "table by `--rows`");
}

Points usable(std::span<const double> x, std::span<const double> y, const PronySeries& series,
              Fit& fit) {
  const int needed = series.terms > most_free_terms ? series.terms + 2 : 2 * series.terms + 2;
  const std::vector<double>& samples = series.history.samples;
  assert(samples.empty() || samples.size() == x.size());
  Points points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    if (!samples.empty() && !std::isfinite(samples[i])) continue;
    if (!samples.empty()) points.history.samples.push_back(samples[i]);
    points.x.push_back(x[i] - fit.x_origin);
    points.y.push_back(y[i]);
    fit.range_low = std::fmin(fit.range_low, x[i]);
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  fit.n = static_cast<int>(points.x.size());
  fit.excluded = static_cast<int>(x.size()) - fit.n;
  need_points(fit.name, as_index(needed), points.x.size(), " for this number of terms",
              "; record more points, or give fewer `--terms`");
  if (fit.range_low == fit.range_high)
    throw InputError({}, "all points have the same x; give a curve over time");
  points.x_scale = fit.range_high - fit.range_low;
  points.y_scale = scale_to_one(points.y);
  for (double& each : points.x) each /= points.x_scale;
  points.history.ramp = series.history.ramp / points.x_scale;
  scale_history(points);
  std::vector<double> sorted = points.x;
  std::ranges::sort(sorted);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] > sorted[i - 1])
      points.least_gap = std::min(points.least_gap, sorted[i] - sorted[i - 1]);
  return points;
}

// The terms at all points: those of a relaxation, or H minus them in creep. docs/theory.md [prony]
class Basis {
 public:
  Basis(const Points& points, const PronySeries& series)
      : points_(points),
        kind_(series.kind),
        history_(points.history),
        constant_(loading(points.x, history_)) {
    const bool relaxation = kind_ == PronySeries::Kind::relaxation;
    if (!(series.liquid && relaxation)) leading_.push_back(constant_);
    if (series.liquid && !relaxation) leading_.push_back(flow());
  }

  // The columns before the terms: H, and its integral for a liquid that creeps.
  [[nodiscard]] const std::vector<std::vector<double>>& leading() const { return leading_; }

  [[nodiscard]] BasisColumn column(double tau) const {
    BasisColumn column = relaxing(points_.x, tau, history_);
    if (kind_ == PronySeries::Kind::relaxation) return column;
    for (std::size_t i = 0; i < column.value.size(); ++i) {
      column.value[i] = constant_[i] - column.value[i];
      column.slope[i] = -column.slope[i];
    }
    return column;
  }

 private:
  // int_0^x H
  [[nodiscard]] std::vector<double> flow() const {
    std::vector<double> values;
    double sum = 0.0;
    const double ramp = history_.ramp;
    for (std::size_t i = 0; i < points_.x.size(); ++i) {
      const double x = points_.x[i];
      if (!history_.samples.empty()) {
        if (i > 0)
          sum += 0.5 * (history_.samples[i] + history_.samples[i - 1]) * (x - points_.x[i - 1]);
        values.push_back(sum);
      } else {
        values.push_back(x < ramp ? 0.5 * std::max(x, 0.0) * std::max(x, 0.0) / ramp
                                  : x - 0.5 * ramp);
      }
    }
    return values;
  }

  const Points& points_;
  PronySeries::Kind kind_;
  const LoadingHistory& history_;
  std::vector<double> constant_;
  std::vector<std::vector<double>> leading_;
};

// Geometrically spaced times between two limits, in the unit of the scaled x.
std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i)
    times.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  return times;
}

// At most 400 rows of the leading columns and of those of the times, and the values of y.
struct Thinned {
  Eigen::MatrixXd columns;  // the leading ones first
  Eigen::VectorXd target;
};
Thinned thinned(const Points& points, const Basis& basis, std::span<const double> times,
                std::size_t most) {
  const std::size_t stride = 1 + points.x.size() / most;
  const auto rows = static_cast<Eigen::Index>((points.x.size() + stride - 1) / stride);
  std::vector<std::vector<double>> columns = basis.leading();
  for (const double time : times) columns.push_back(basis.column(time).value);
  Thinned made{Eigen::MatrixXd(rows, static_cast<Eigen::Index>(columns.size())),
               Eigen::VectorXd(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    made.target(i) = points.y[as_index(i) * stride];
    for (std::size_t k = 0; k < columns.size(); ++k)
      made.columns(i, static_cast<Eigen::Index>(k)) = columns[k][as_index(i) * stride];
  }
  return made;
}

// The best combination of `terms` different times of a grid. Returns the unknowns of the search:
// the factors of the leading columns, then y_k and ln tau_k of each term.
std::vector<double> start_of(const Points& points, const Basis& basis, int terms) {
  constexpr int count = 12;
  const std::vector<double> times = spaced(std::max(points.least_gap, 1e-5), 3.0, count);
  const Thinned grid = thinned(points, basis, times, 400);
  if (!grid.columns.allFinite()) return {};
  const auto lead = static_cast<Eigen::Index>(basis.leading().size());
  std::vector<char> chosen(times.size(), 0);
  std::fill_n(chosen.begin(), terms, 1);
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  do {
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (chosen[i] != 0) some.push_back(i);
    Eigen::MatrixXd matrix(grid.columns.rows(), lead + static_cast<Eigen::Index>(some.size()));
    matrix.leftCols(lead) = grid.columns.leftCols(lead);
    for (std::size_t k = 0; k < some.size(); ++k)
      matrix.col(lead + static_cast<Eigen::Index>(k)) =
          grid.columns.col(lead + static_cast<Eigen::Index>(some[k]));
    const Eigen::VectorXd heights = dense::least_squares(matrix, grid.target);
    const double squares = (matrix * heights - grid.target).squaredNorm();
    if (!heights.allFinite() || !(squares < least)) continue;
    least = squares;
    best.assign(heights.begin(), heights.begin() + lead);
    for (std::size_t k = 0; k < some.size(); ++k) {
      best.push_back(heights(lead + static_cast<Eigen::Index>(k)));
      best.push_back(std::log(times[some[k]]));
    }
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

// Sorts the terms by increasing tau, since the search may have changed their order, and replaces ln
// tau by tau. `lead` parameters stand before the terms.
void finish_terms(Minimum& minimum, std::size_t lead) {
  const std::size_t count = minimum.parameters.size();
  std::vector<std::size_t> terms((count - lead) / 2);
  std::iota(terms.begin(), terms.end(), std::size_t{0});
  std::ranges::stable_sort(terms, [&](std::size_t a, std::size_t b) {
    return minimum.parameters[lead + 2 * a + 1] < minimum.parameters[lead + 2 * b + 1];
  });
  std::vector<std::size_t> from(lead);
  std::iota(from.begin(), from.end(), std::size_t{0});
  for (const std::size_t k : terms) {
    from.push_back(lead + 2 * k);
    from.push_back(lead + 2 * k + 1);
  }
  reorder_parameters(minimum, from);
  for (std::size_t i = lead + 1; i < count; i += 2) {
    const double tau = std::exp(minimum.parameters[i]);
    replace_parameter(minimum, static_cast<Eigen::Index>(i), tau, tau);
  }
}

// Times spaced evenly in their logarithm, and heights of 0 or more.
void fit_given_times(Fit& fit, const Points& points, const Basis& basis,
                     const PronySeries& series) {
  const std::vector<double> times = spaced(std::max(points.least_gap, 1e-5), 1.0, series.terms);
  const Thinned all = thinned(points, basis, times, 20000);
  const auto heights = nonnegative_least_squares(all.columns, all.target);
  fit.termination = Termination::not_converged;
  if (!heights) return;
  fit.termination = Termination::converged;
  const Eigen::VectorXd residuals = all.columns * *heights - all.target;
  fit.rmse =
      std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.size())) * points.y_scale;
  const Eigen::VectorXd about = all.target.array() - all.target.mean();
  fit.r2 = about.squaredNorm() > 0.0 ? 1.0 - residuals.squaredNorm() / about.squaredNorm()
                                     : Estimate::unknown;
  const std::size_t lead = basis.leading().size();
  std::vector<Estimate> kept;
  for (std::size_t k = 0; k < lead; ++k) {
    kept.push_back(fit.parameters[k]);
    kept.back().estimate =
        (*heights)[static_cast<Eigen::Index>(k)] * points.y_scale / (k == 1 ? points.x_scale : 1.0);
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double height = (*heights)[static_cast<Eigen::Index>(lead + k)];
    if (height <= 0.0) continue;
    kept.push_back(fit.parameters[lead + 2 * k]);
    kept.back().estimate = height * points.y_scale;
    kept.push_back(fit.parameters[lead + 2 * k + 1]);
    kept.back().estimate = times[k] * points.x_scale;
  }
  fit.notes.push_back(std::to_string((kept.size() - lead) / 2) + " of " +
                      std::to_string(series.terms) +
                      " terms are above 0; their times are given, so that they have no intervals");
  fit.parameters = std::move(kept);
}

std::string law_of(const PronySeries& series) {
  const bool relaxation = series.kind == PronySeries::Kind::relaxation;
  std::string law =
      relaxation ? std::string("y = ") + (series.liquid ? "" : "y_inf + ") + "sum y_k e^(-x/tau_k)"
                 : std::string("y = y_0 + ") + (series.liquid ? "y_flow x + " : "") +
                       "sum y_k (1 - e^(-x/tau_k))";
  if (series.history.ramp > 0.0)
    law += ", after a ramp of " + rounded_text(series.history.ramp) + " (Boltzmann)";
  if (!series.history.samples.empty())
    law += ", under the loading history of the file, relative to its largest (Boltzmann)";
  if (series.terms > most_free_terms) law += ", non-negative, with given times";
  return law;
}

}  // namespace

// Closed forms for steps and ramps, a recursion for histories that were measured.
BasisColumn relaxing(std::span<const double> t, double tau, const LoadingHistory& history) {
  BasisColumn column;
  column.value.reserve(t.size());
  column.slope.reserve(t.size());
  if (history.samples.empty()) {
    for (const double each : t) {
      const Term term =
          history.ramp > 0.0 ? after_ramp(each, tau, history.ramp) : after_step(each, tau);
      column.value.push_back(term.value);
      column.slope.push_back(term.slope);
    }
    return column;
  }
  // phi_i = phi_(i-1) e^(-d/tau) + r tau (1 - e^(-d/tau)), r the rate of the history in d
  double value = history.samples.front();
  double slope = 0.0;
  column.value.push_back(value);
  column.slope.push_back(slope);
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double d = t[i] - t[i - 1];
    const double change = history.samples[i] - history.samples[i - 1];
    if (d <= 0.0) {
      value += change;
    } else {
      const double left = std::exp(-d / tau);
      const double gain = -tau / d * std::expm1(-d / tau);  // of a ramp over d
      slope = left * (slope + value * d / tau) + change * (gain - left);
      value = left * value + change * gain;
    }
    column.value.push_back(value);
    column.slope.push_back(slope);
  }
  return column;
}

std::vector<double> loading(std::span<const double> t, const LoadingHistory& history) {
  if (!history.samples.empty()) return history.samples;
  std::vector<double> values;
  for (const double each : t)
    values.push_back(history.ramp > 0.0 ? std::clamp(each / history.ramp, 0.0, 1.0) : 1.0);
  return values;
}

// The rows are first reduced to as many as there are columns by a QR decomposition.
std::optional<Eigen::VectorXd> nonnegative_least_squares(const Eigen::MatrixXd& given,
                                                         const Eigen::VectorXd& target) {
  const Eigen::Index n = given.cols();
  const auto [q, a] = dense::qr(given);
  const Eigen::VectorXd b = q.transpose() * target;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<char> free(static_cast<std::size_t>(n), 0);
  const double small = 1e-13 * a.colwise().norm().maxCoeff() * target.norm();
  for (Eigen::Index change = 0; change <= 3 * n; ++change) {
    // The gradient's largest component among the columns held at 0.
    const Eigen::VectorXd gradient = a.transpose() * (b - a * x);
    Eigen::Index next = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (free[static_cast<std::size_t>(i)] == 0 && gradient[i] > small &&
          (next < 0 || gradient[i] > gradient[next]))
        next = i;
    if (next < 0) return x;
    free[static_cast<std::size_t>(next)] = 1;
    // Back to the border as long as a free coefficient would become negative.
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      const Eigen::VectorXd wanted = over_free(a, b, free);
      double step = 1.0;
      for (Eigen::Index i = 0; i < n; ++i)
        if (free[static_cast<std::size_t>(i)] != 0 && wanted[i] <= 0.0)
          step = std::min(step, x[i] / (x[i] - wanted[i]));
      x += step * (wanted - x);
      if (step >= 1.0) break;
      for (Eigen::Index i = 0; i < n; ++i)
        if (free[static_cast<std::size_t>(i)] != 0 && x[i] <= 1e-15 * x.cwiseAbs().maxCoeff()) {
          free[static_cast<std::size_t>(i)] = 0;
          x[i] = 0.0;
        }
    }
  }
  return std::nullopt;
}

Fit fit_prony(std::span<const double> x, std::span<const double> y, const PronySeries& series,
              const Options& options) {
  assert(x.size() == y.size() && series.terms >= 1 && series.terms <= most_terms);
  const bool relaxation = series.kind == PronySeries::Kind::relaxation;
  Fit fit;
  fit.name = relaxation ? "prony" : "prony_creep";
  fit.law = law_of(series);
  fit.x_origin = options.x_origin;
  if (!(series.liquid && relaxation))
    fit.parameters.push_back({.name = relaxation ? "y_inf" : "y_0", .unit = options.y_unit});
  if (series.liquid && !relaxation)
    fit.parameters.push_back(
        {.name = "y_flow",
         .unit = options.x_unit.empty()
                     ? options.y_unit
                     : (options.y_unit.empty() ? "1" : options.y_unit) + "/" + options.x_unit});
  for (int k = 1; k <= series.terms; ++k) {
    fit.parameters.push_back({.name = "y_" + std::to_string(k), .unit = options.y_unit});
    fit.parameters.push_back({.name = "tau_" + std::to_string(k), .unit = options.x_unit});
  }
  const Points points = usable(x, y, series, fit);
  const Basis basis(points, series);
  if (series.terms > most_free_terms) {
    fit_given_times(fit, points, basis, series);
    return fit;
  }
  const std::vector<double> start = start_of(points, basis, series.terms);
  if (start.empty()) return fit;

  const std::size_t count = start.size();
  const std::size_t lead = basis.leading().size();
  const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                            std::span<double> slopes) {
    std::ranges::fill(values, 0.0);
    for (std::size_t k = 0; k < lead; ++k)
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] += p[k] * basis.leading()[k][i];
        if (!slopes.empty()) slopes[i * count + k] = basis.leading()[k][i];
      }
    for (std::size_t k = lead; k < count; k += 2) {
      const BasisColumn column = basis.column(std::exp(p[k + 1]));
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] += p[k] * column.value[i];
        if (slopes.empty()) continue;
        slopes[i * count + k] = column.value[i];
        slopes[i * count + k + 1] = p[k] * column.slope[i];
      }
    }
    return true;
  };
  Minimum minimum = minimise(points.y, curve, start, {.max_iterations = options.max_iterations});
  std::vector<double> scale(count, points.y_scale);
  if (lead > 1) scale[1] /= points.x_scale;
  for (std::size_t i = lead + 1; i < count; i += 2) scale[i] = points.x_scale;
  if (minimum.status != Minimum::Status::failed) finish_terms(minimum, lead);
  settle(fit, minimum, {points.y, points.y_scale, scale, options.residuals});
  return fit;
}

namespace {

struct NamedLaw {
  const char* name;
  const char* law;
};
constexpr std::array<NamedLaw, 3> fractional_laws{{
    {"spring_pot", "y = c x^-beta / Gamma(1-beta), Blair 1947"},
    {"spring_pot_creep", "y = J x^beta / Gamma(1+beta), Blair 1947"},
    {"fractional_zener",
     "y = y_inf + (y_0 - y_inf) E_beta(-(x/tau)^beta), Mittag-Leffler's function, Mainardi 2010"},
}};

double exponent_of(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// The parameters' units: a spring-pot's factor has a power of the time that depends on beta.
std::vector<Estimate> parameters_of(Fractional model, const Options& options) {
  const std::string& y = options.y_unit;
  const std::string& x = options.x_unit;
  const std::string power = x.empty() ? "" : x + "^beta";
  const std::string each = y.empty() ? "1" : y;
  if (model == Fractional::zener)
    return {{.name = "y_inf", .unit = y},
            {.name = "y_0", .unit = y},
            {.name = "tau", .unit = x},
            {.name = "beta"}};
  if (model == Fractional::spring_pot)
    return {{.name = "c",
             .unit = power.empty() ? y
                     : y.empty()   ? power
                                   : y + " " + power},
            {.name = "beta"}};
  return {{.name = "J", .unit = power.empty() ? y : each + "/" + power}, {.name = "beta"}};
}

}  // namespace

double mittag_leffler(double alpha, double z) {
  assert(alpha > 0.0 && alpha <= 1.0 && z >= 0.0);
  // f(1) = 1/(2 pi i) int e^s F(s) ds over s = mu (1 + i u)^2, with the trapezoidal rule of step h.
  constexpr int half = 16;  // the error falls as e^(-2 pi N / 3)
  constexpr double step = 3.0 / half;
  constexpr double mu = std::numbers::pi * half / 12.0;
  std::complex<double> sum = 0.0;
  for (int k = 0; k < half; ++k) {  // symmetric in u: the midpoints of one side
    const double u = step * (k + 0.5);
    const std::complex<double> along(1.0, u);
    const std::complex<double> s = mu * along * along;
    // By real functions, whose bits are the same on every processor.
    const double size = std::pow(mu * (1.0 + u * u), alpha);
    const double angle = 2.0 * alpha * std::atan2(u, 1.0);
    const std::complex<double> power(size * std::cos(angle), size * std::sin(angle));
    const std::complex<double> turned(std::cos(s.imag()), std::sin(s.imag()));
    sum += std::exp(s.real()) * turned * power / (s * (power + z)) * along;
  }
  return 2.0 * mu * step / std::numbers::pi * sum.real();
}

Fit fit_fractional(std::span<const double> x, std::span<const double> y, Fractional model,
                   const Options& options) {
  assert(x.size() == y.size());
  Fit fit;
  fit.name = fractional_laws[as_index(model)].name;
  fit.law = fractional_laws[as_index(model)].law;
  fit.x_origin = options.x_origin;
  fit.parameters = parameters_of(model, options);
  std::vector<double> times, values;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = x[i] - options.x_origin;
    if (!std::isfinite(t) || !std::isfinite(y[i]) || !(t > 0.0)) continue;
    times.push_back(t);
    values.push_back(y[i]);
    fit.range_low = std::fmin(fit.range_low, x[i]);
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  fit.n = static_cast<int>(times.size());
  fit.excluded = static_cast<int>(x.size()) - fit.n;
  const std::size_t count = fit.parameters.size();
  need_points(fit.name, count + 1, times.size(), " after the step",
              "; record more points, or give `--origin`");
  const double y_scale = scale_to_one(values);
  const double length = *std::ranges::max_element(times);
  for (double& each : times) each /= length;

  Separable curve;  // its shapes: the logarithm of tau, and the logit of beta
  const bool zener = model == Fractional::zener;
  curve.linear = zener ? 2 : 1;
  if (zener) {
    for (const double log : {-6.0, -4.0, -2.5, -1.0, 0.5})
      for (const double logit : {-2.0, -1.0, 0.0, 1.0, 2.5}) curve.starts.push_back({log, logit});
    curve.columns = [&](std::span<const double> s, std::span<double> phi) {
      const double tau = std::exp(s[0]);
      const double beta = exponent_of(s[1]);
      if (!(beta > 1e-3) || !std::isfinite(tau) || !(tau > 0.0)) return false;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double left = mittag_leffler(beta, std::pow(times[i] / tau, beta));
        phi[2 * i] = 1.0 - left;
        phi[2 * i + 1] = left;
      }
      return true;
    };
  } else {
    const double sign = model == Fractional::spring_pot ? -1.0 : 1.0;
    for (double logit = -4.0; logit < 4.1; logit += 0.5) curve.starts.push_back({logit});
    curve.columns = [&, sign](std::span<const double> s, std::span<double> phi) {
      const double beta = exponent_of(s[0]);
      const double gamma = std::tgamma(1.0 + sign * beta);
      for (std::size_t i = 0; i < times.size(); ++i)
        phi[i] = std::pow(times[i], sign * beta) / gamma;
      return true;
    };
  }
  Minimum minimum = minimise(values, curve, options.max_iterations);
  std::vector<double> scale(count, 1.0);
  if (minimum.status != Minimum::Status::failed) {
    const double beta = exponent_of(minimum.parameters.back());
    replace_parameter(minimum, minimum.jacobian.cols() - 1, beta, beta * (1.0 - beta));
    if (zener) {
      const double tau = std::exp(minimum.parameters[2]);
      replace_parameter(minimum, 2, tau, tau);
      scale = {y_scale, y_scale, length, 1.0};
    } else {
      // c of y = c (x/L)^-beta is c L^beta of x^-beta, which depends on beta too.
      const double sign = model == Fractional::spring_pot ? 1.0 : -1.0;
      const double factor = std::pow(length, sign * beta);
      const double by_beta = sign * std::log(length) * minimum.parameters[0];
      add_to_parameter(minimum, 0, 1, by_beta);
      scale = {y_scale * factor, 1.0};
    }
  }
  settle(fit, minimum, {values, y_scale, scale, options.residuals});
  return fit;
}

}  // namespace palpate::fit
