// The ends of a profile by false position; the other unknowns are fitted again at every point.
#include "identify/box_profile.h"

#include <algorithm>
#include <cmath>

namespace palpate::identify {
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
