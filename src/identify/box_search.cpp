// Least squares over the box by Levenberg-Marquardt, with slopes by central differences.
#include "identify/box_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.h"
#include "base/text.h"
#include "fit/ceres_fit.h"

namespace palpate::identify {
namespace {

// The search goes over 1 + u, so that its tolerances, which are relative, fit the box.
constexpr double shift = 1.0;
constexpr double step = 1e-4;  // of 1 + u: an error of order step^2 / 6, far below the noise

// The weighted curve over the unknowns that the search may change.
class Weighted {
 public:
  Weighted(const BoxProblem& problem, std::span<const double> u, std::span<const char> held)
      : problem_(&problem), u_(u.begin(), u.end()) {
    for (std::size_t i = 0; i < u.size(); ++i)
      if (held.empty() || held[i] == 0) places_.push_back(i);
    for (std::size_t i = 0; i < problem.measured.size(); ++i)
      measured_.push_back(problem.measured[i] * problem.weights[i]);
  }

  [[nodiscard]] const std::vector<std::size_t>& places() const { return places_; }
  [[nodiscard]] const std::vector<double>& measured() const { return measured_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }

  // As fit::CurveAt wants it.
  bool operator()(std::span<const double> moved, std::span<double> values,
                  std::span<double> slopes) {
    std::vector<double> u = u_;
    for (std::size_t k = 0; k < places_.size(); ++k) u[places_[k]] = moved[k] - shift;
    if (!continued(u, values)) return false;
    if (!slopes.empty() && !by_differences(u, slopes)) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] *= problem_->weights[i];
      for (std::size_t k = 0; k < slopes.size() / values.size(); ++k)
        slopes[i * places_.size() + k] *= problem_->weights[i];
    }
    return true;
  }

 private:
  bool curve(std::span<const double> u, std::span<double> values) {
    ++evaluations_;
    return problem_->curve(u, values) &&
           std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
  }

  // Beyond the box y(u) = 2 y(bound) - y(mirrored), so that a central difference at a bound equals
  // the one-sided difference inside the box.
  bool continued(std::span<const double> u, std::span<double> values) {
    std::vector<double> bound(u.begin(), u.end());
    std::vector<double> mirrored(u.begin(), u.end());
    bool outside = false;
    for (std::size_t i = 0; i < u.size(); ++i) {
      bound[i] = std::clamp(u[i], 0.0, 1.0);
      mirrored[i] = 2.0 * bound[i] - u[i];
      outside = outside || bound[i] != u[i];
    }
    if (!outside) return curve(u, values);
    std::vector<double> at_bound(values.size());
    if (!curve(bound, at_bound) || !curve(mirrored, values)) return false;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 2.0 * at_bound[i] - values[i];
    return true;
  }

  bool by_differences(std::vector<double> u, std::span<double> slopes) {
    const std::size_t points = measured_.size();
    std::vector<double> above(points), below(points);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      double& at = u[places_[k]];
      const double middle = at;
      const double change = step * std::abs(middle + shift);
      at = middle + change;
      if (!continued(u, above)) return false;
      at = middle - change;
      if (!continued(u, below)) return false;
      at = middle;
      for (std::size_t i = 0; i < points; ++i)
        slopes[i * places_.size() + k] = (above[i] - below[i]) / (2.0 * change);
    }
    return true;
  }

  const BoxProblem* problem_;
  std::vector<double> u_;
  std::vector<std::size_t> places_;
  std::vector<double> measured_;
  int evaluations_ = 0;
};

}  // namespace

BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u, Want want) {
  BoxMinimum at;
  at.u.assign(u.begin(), u.end());
  Weighted curve(problem, u, {});
  std::vector<double> moved;
  for (const double each : u) moved.push_back(each + shift);
  std::vector<double> values(problem.measured.size());
  if (want == Want::slopes)
    at.jacobian.resize(static_cast<Eigen::Index>(values.size()),
                       static_cast<Eigen::Index>(u.size()));
  at.found = curve(moved, values, {at.jacobian.data(), as_index(at.jacobian.size())});
  at.evaluations = curve.evaluations();
  if (!at.found) return at;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double residual = values[i] - curve.measured()[i];
    at.squares += residual * residual;
  }
  at.found = at.jacobian.allFinite();
  return at;
}

BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                           std::span<const char> held, Want want) {
  Weighted curve(problem, start, held);
  std::vector<double> u(start.begin(), start.end());
  if (!curve.places().empty()) {
    std::vector<double> moved;
    for (const std::size_t place : curve.places())
      moved.push_back(std::clamp(start[place], 0.0, 1.0) + shift);
    // A relative error e of the squares means an error of sqrt(e n) standard errors for n points
    // with noise: about 1e-3 for a scene, where further digits would cost more runs than they are
    // worth.
    const bool formula = problem.exact;
    const fit::Minimum minimum = fit::minimise(curve.measured(), std::ref(curve), moved,
                                               {.max_iterations = 60,
                                                .low = shift,
                                                .high = shift + 1.0,
                                                .gradient_tolerance = 0.0,
                                                .parameter_tolerance = formula ? 1e-12 : 1e-8,
                                                .function_tolerance = formula ? 1e-14 : 1e-9,
                                                .errors = false});
    if (minimum.status == fit::Minimum::Status::failed) {
      BoxMinimum none;
      none.evaluations = curve.evaluations();
      return none;
    }
    for (std::size_t k = 0; k < moved.size(); ++k)
      u[curve.places()[k]] = std::clamp(minimum.parameters[k] - shift, 0.0, 1.0);
  }
  BoxMinimum minimum = evaluate_in_box(problem, u, want);
  minimum.evaluations += curve.evaluations();
  return minimum;
}

// Starting points by radical inverses to the first primes (Halton 1960, Numer. Math. 2).

namespace {

constexpr std::array<int, 10> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29};

double radical_inverse(int number, int base) {
  double inverse = 0.0;
  double digit = 1.0 / base;
  for (; number > 0; number /= base, digit /= base) inverse += (number % base) * digit;
  return inverse;
}

}  // namespace

std::vector<std::vector<double>> search_starts(std::size_t unknowns) {
  std::vector<std::vector<double>> starts{std::vector<double>(unknowns, 0.5)};
  for (std::size_t k = 1; k <= 4 * unknowns; ++k) {
    starts.emplace_back();
    for (std::size_t i = 0; i < unknowns; ++i)
      starts.back().push_back(
          radical_inverse(static_cast<int>(k + i / primes.size()), primes[i % primes.size()]));
  }
  return starts;
}

SearchResult search_from_several(const BoxProblem& problem, int searches) {
  struct Start {
    std::vector<double> u;
    double squares;
  };
  SearchResult result;
  std::vector<Start> starts;
  for (const std::vector<double>& u : search_starts(problem.unknowns)) {
    const BoxMinimum at = evaluate_in_box(problem, u, Want::squares);
    result.evaluations += at.evaluations;
    if (at.found) starts.push_back({u, at.squares});
  }
  std::ranges::stable_sort(starts, {}, &Start::squares);
  for (std::size_t k = 0; k < std::min(as_index(searches), starts.size()); ++k) {
    BoxMinimum minimum = minimise_in_box(problem, starts[k].u, {});
    result.evaluations += minimum.evaluations;
    // Of minima that are equal up to rounding, the first is kept.
    if (minimum.found &&
        (!result.best.found || minimum.squares < result.best.squares * (1.0 - 1e-9)))
      result.best = std::move(minimum);
  }
  return result;
}

// The ends of a profile by false position; the other unknowns are fitted again at every point.

namespace {

class Side {
 public:
  Side(const BoxProblem& problem, const BoxMinimum& best, std::size_t i, Profile& profile)
      : problem_(problem), best_(best), i_(i), profile_(profile), held_(best.u.size(), 0) {
    held_[i] = 1;
  }

  // The least squares with the unknown held at u, or NaN; `start` is replaced by the minimum.
  double squares(double u, std::vector<double>& start) {
    start[i_] = u;
    BoxMinimum at = minimise_in_box(problem_, start, held_, Want::squares);
    profile_.evaluations += at.evaluations;
    if (!at.found) {  // the curve cannot be evaluated at `start`: begin at the best fit instead
      start = best_.u;
      start[i_] = u;
      at = minimise_in_box(problem_, start, held_, Want::squares);
      profile_.evaluations += at.evaluations;
    }
    if (!at.found) return std::nan("");
    start = at.u;
    profile_.points.push_back({u, at.squares, at.u});
    return at.squares;
  }

  // The end on the side `sign` of the best fit; `guess` is the half width of Student's interval.
  std::optional<double> end(double sign, double guess, const dense::Matrix& covariance,
                            double sigma, double t) {
    const auto with = covariance.col(static_cast<Eigen::Index>(i_));
    const double room = sign > 0.0 ? 1.0 - best_.u[i_] : best_.u[i_];
    // The root of the likelihood ratio is nearly linear in the distance.
    const auto root = [&](double distance, std::vector<double>& start) {
      const double over = squares(best_.u[i_] + sign * distance, start) - best_.squares;
      return std::sqrt(std::max(0.0, over)) / sigma;
    };
    std::vector<double> start = best_.u;
    const auto predict = [&](double distance) {  // the other unknowns in a linear model
      const double own = with[static_cast<Eigen::Index>(i_)];
      for (std::size_t j = 0; j < start.size(); ++j)
        if (j != i_ && own > 0.0)
          start[j] = std::clamp(
              best_.u[j] + sign * distance * with[static_cast<Eigen::Index>(j)] / own, 0.0, 1.0);
    };
    double near = 0.0;
    double near_root = 0.0;
    double far = std::min(room, guess);
    if (far > 1e-9) {
      predict(0.5 * far);  // a point for the figure
      (void)squares(best_.u[i_] + sign * 0.5 * far, start);
    }
    predict(far);
    double far_root = root(far, start);
    constexpr int most_tries = 20;
    for (int k = 0; k < most_tries && far_root < t; ++k) {
      if (far >= room) return std::nullopt;
      near = far;
      near_root = far_root;
      far = std::min(room, far * std::clamp(1.1 * t / std::max(far_root, 1e-3), 1.2, 3.0));
      far_root = root(far, start);
    }
    if (!(far_root >= t)) return std::nullopt;
    for (int k = 0; k < most_tries && far_root - t > 1e-2 * t; ++k) {
      const double middle = near + (far - near) * (t - near_root) / (far_root - near_root);
      predict(middle);
      const double middle_root = root(middle, start);
      if (std::isnan(middle_root)) return std::nullopt;
      if (std::abs(middle_root - t) <= 1e-2 * t) {
        far = middle;
        far_root = middle_root;
        near = middle;
        break;
      }
      (middle_root < t ? near : far) = middle;
      (middle_root < t ? near_root : far_root) = middle_root;
    }
    // Linear interpolation of the root between the last two points, or through the last point.
    const double through = far > near
                               ? near + (far - near) * (t - near_root) / (far_root - near_root)
                               : far * t / far_root;
    return std::clamp(best_.u[i_] + sign * through, 0.0, 1.0);
  }

 private:
  const BoxProblem& problem_;
  const BoxMinimum& best_;
  std::size_t i_;
  Profile& profile_;
  std::vector<char> held_;
};

void finish(Profile& profile, const BoxMinimum& best, std::size_t i) {
  profile.points.push_back({best.u[i], best.squares, best.u});
  std::ranges::stable_sort(profile.points,
                           [](const auto& one, const auto& other) { return one.u < other.u; });
}

}  // namespace

Profile profile(const BoxProblem& problem, const BoxMinimum& best, std::size_t i,
                const dense::Matrix& covariance, double sigma, double t) {
  Profile found;
  Side side(problem, best, i, found);
  const double own = covariance.diagonal()[static_cast<Eigen::Index>(i)];
  const double guess = own > 0.0 ? t * std::sqrt(own) : 0.05;
  found.low = side.end(-1.0, guess, covariance, sigma, t);
  found.high = side.end(1.0, guess, covariance, sigma, t);
  finish(found, best, i);
  return found;
}

Profile profile_over_box(const BoxProblem& problem, const BoxMinimum& best, std::size_t i) {
  Profile found;
  Side side(problem, best, i, found);
  constexpr int points = 8;
  std::vector<double> start = best.u;
  for (int k = 0; k <= points; ++k) (void)side.squares(static_cast<double>(k) / points, start);
  finish(found, best, i);
  return found;
}

// Errors from the singular values of the jacobian, and the combination of not separately
// identifiable unknowns.

namespace {

constexpr double loose_half_width = 0.5;  // of the box, at 95 %
// Interpolation and differentiation of scenes have relative errors of about 1e-5 and 1e-7: smaller
// noise and smaller slopes have no meaning.
constexpr double least_sigma = 1e-5;
constexpr double least_slope = 1e-6;  // of the steepest direction

// d ln p / du, and dp / du with p in the unknown's unit.
double log_slope(const Unknown& unknown, double u) { return unknown.slope(u) / unknown.value(u); }
double shown_slope(const Unknown& unknown, double u) { return unknown.shown(unknown.slope(u)); }

std::string with_exponent(const std::string& text, double exponent) {
  if (text.empty() || exponent == 1.0) return text;
  return text + "^" + rounded_text(exponent, 3);
}

}  // namespace

dense::Rows determined_directions(const dense::Rows& jacobian) {
  const dense::Svd svd = dense::svd(jacobian);
  const Eigen::VectorXd& sizes = svd.values;
  return svd.u.leftCols((sizes.array() > least_slope * sizes[0]).count());
}

BoxErrors box_errors(const dense::Rows& jacobian, const dense::Matrix& noise, double t,
                     int weakest) {
  const Eigen::Index n = jacobian.cols();
  const dense::Svd svd = dense::svd(jacobian);
  const Eigen::Index count = noise.rows();
  BoxErrors errors;
  errors.inseparable.assign(as_index(n), 0);
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(n, count);  // of u to the directions
  std::vector<Eigen::VectorXd> loose;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double slope = svd.values[k];
    if (k >= n - weakest || k >= count ||
        t * std::max(std::sqrt(noise(k, k)), least_sigma) > loose_half_width * slope) {
      loose.emplace_back(svd.v.col(k));
      continue;
    }
    ++errors.determined;
    response.col(k) = svd.v.col(k) / slope;
  }
  const Eigen::MatrixXd back = response.transpose();
  errors.covariance = dense::product(dense::product(response, noise), back);
  errors.of_one = dense::product(response, back);
  for (const Eigen::VectorXd& direction : loose) {
    errors.loose.emplace_back(direction.data(), direction.data() + n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double own = t * std::sqrt(errors.covariance(i, i));
      const double moved = loose_half_width * std::abs(direction[i]);
      if (moved > std::max(own, 1e-3)) errors.inseparable[as_index(i)] = 1;
    }
  }
  return errors;
}

std::optional<Combination> combination(const BoxErrors& errors, std::span<const Unknown> unknowns,
                                       std::span<const double> u, double t) {
  Combination found;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (errors.inseparable[i] != 0) found.of.push_back(i);
  const std::size_t m = found.of.size();
  if (m < 2 || errors.loose.size() + 1 != m) return std::nullopt;

  // The direction within the inseparable unknowns that is orthogonal to all loose directions.
  Eigen::MatrixXd loose(static_cast<Eigen::Index>(m - 1), static_cast<Eigen::Index>(m));
  for (std::size_t k = 0; k + 1 < m; ++k)
    for (std::size_t i = 0; i < m; ++i)
      loose(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          errors.loose[k][found.of[i]];
  const dense::Svd svd = dense::svd(loose);
  const Eigen::VectorXd kept = svd.v.col(static_cast<Eigen::Index>(m) - 1);

  std::vector<double> gradient(unknowns.size(), 0.0);  // d (combination or its logarithm) / du
  const auto error = [&] {
    double variance = 0.0;
    for (std::size_t i = 0; i < gradient.size(); ++i)
      for (std::size_t j = 0; j < gradient.size(); ++j)
        variance += gradient[i] * gradient[j] * errors.variance(i, j);
    return std::sqrt(std::max(0.0, variance));
  };
  const auto finish_by_logarithm = [&](double value) {
    found.gradient = gradient;
    found.product = true;
    const double log_error = error();
    found.estimate = value;
    found.std_error = value * log_error;
    found.ci95_low = value * std::exp(-t * log_error);
    found.ci95_high = value * std::exp(t * log_error);
    return found;
  };

  // E / (1 - nu^2): Hertz's law depends on E and nu through this modulus only.
  const std::size_t a = found.of[0];
  const std::size_t b = found.of[1];
  const bool elastic = m == 2 && (unknowns[a].key.ends_with(".young_modulus") ||
                                  unknowns[b].key.ends_with(".young_modulus"));
  if (elastic) {
    const std::size_t e = unknowns[a].key.ends_with(".young_modulus") ? a : b;
    const std::size_t r = e == a ? b : a;
    const double nu = unknowns[r].value(u[r]);
    gradient[e] = log_slope(unknowns[e], u[e]);
    gradient[r] = 2.0 * nu / (1.0 - nu * nu) * unknowns[r].slope(u[r]);
    const double along_e = gradient[e] * errors.loose[0][e];
    const double along_r = gradient[r] * errors.loose[0][r];
    if (unknowns[r].key.ends_with(".poisson_ratio") &&
        std::abs(along_e + along_r) <= 0.05 * std::abs(along_e)) {
      found.text = unknowns[e].name() + " / (1 - " + unknowns[r].name() + "^2)";
      found.unit = unknowns[e].unit_text();
      return finish_by_logarithm(unknowns[e].shown(unknowns[e].value(u[e])) / (1.0 - nu * nu));
    }
  }

  const bool powers =
      std::ranges::all_of(found.of, [&](std::size_t i) { return unknowns[i].low > 0.0; });
  const auto slope = [&](std::size_t i) {
    return powers ? log_slope(unknowns[i], u[i]) : shown_slope(unknowns[i], u[i]);
  };
  // The first unknown has the exponent or factor 1.
  const double first = kept[0] / slope(a);
  double value = powers ? 1.0 : 0.0;
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = found.of[k];
    const double factor = k == 0 ? 1.0 : kept[static_cast<Eigen::Index>(k)] / slope(i) / first;
    gradient[i] = factor * slope(i);
    const Unknown& unknown = unknowns[i];
    const double shown = unknown.shown(unknown.value(u[i]));
    if (powers) {
      found.exponents.push_back(factor);
      value *= std::pow(shown, factor);
      found.text += (k == 0 ? "" : " * ") + with_exponent(unknown.name(), factor);
      const std::string unit = with_exponent(unknown.unit_text(), factor);
      found.unit += (found.unit.empty() || unit.empty() ? "" : " ") + unit;
    } else {
      value += factor * shown;
      found.text +=
          k == 0 ? unknown.name() : " + " + rounded_text(factor, 3) + " * " + unknown.name();
      if (k == 0) found.unit = unknown.unit_text();
    }
  }
  if (powers) return finish_by_logarithm(value);
  found.gradient = gradient;
  found.estimate = value;
  found.std_error = error();
  found.ci95_low = value - t * found.std_error;
  found.ci95_high = value + t * found.std_error;
  return found;
}

}  // namespace palpate::identify
