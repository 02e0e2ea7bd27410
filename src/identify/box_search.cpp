// Least squares over the box by Levenberg-Marquardt, with slopes by central differences.
#include "identify/box_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

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
           std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
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
  if (want == Want::slopes) at.jacobian.resize(values.size() * u.size());
  at.found = curve(moved, values, at.jacobian);
  at.evaluations = curve.evaluations();
  if (!at.found) return at;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double residual = values[i] - curve.measured()[i];
    at.squares += residual * residual;
  }
  at.found = std::all_of(at.jacobian.begin(), at.jacobian.end(),
                         [](double slope) { return std::isfinite(slope); });
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
  std::stable_sort(starts.begin(), starts.end(), [](const Start& one, const Start& other) {
    return one.squares < other.squares;
  });
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
  std::optional<double> end(double sign, double guess, std::span<const double> covariance,
                            double sigma, double t) {
    const std::size_t n = best_.u.size();
    const double room = sign > 0.0 ? 1.0 - best_.u[i_] : best_.u[i_];
    // The root of the likelihood ratio is nearly linear in the distance.
    const auto root = [&](double distance, std::vector<double>& start) {
      const double over = squares(best_.u[i_] + sign * distance, start) - best_.squares;
      return std::sqrt(std::max(0.0, over)) / sigma;
    };
    std::vector<double> start = best_.u;
    const auto predict = [&](double distance) {  // the other unknowns in a linear model
      const double own = covariance[i_ * n + i_];
      for (std::size_t j = 0; j < n; ++j)
        if (j != i_ && own > 0.0)
          start[j] =
              std::clamp(best_.u[j] + sign * distance * covariance[i_ * n + j] / own, 0.0, 1.0);
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
  std::stable_sort(profile.points.begin(), profile.points.end(),
                   [](const auto& one, const auto& other) { return one.u < other.u; });
}

}  // namespace

Profile profile(const BoxProblem& problem, const BoxMinimum& best, std::size_t i,
                std::span<const double> covariance, double sigma, double t) {
  Profile found;
  Side side(problem, best, i, found);
  const double own = covariance[i * best.u.size() + i];
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

}  // namespace palpate::identify
