// Least squares over the box [0, 1]^n: from one start or from several; standard errors and
// correlations of the unknowns at a minimum, and which of them are not separately identifiable; and
// the profile likelihood of one unknown, the least sum of squares for each fixed value of it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/dense.h"
#include "identify/identify.h"

namespace palpate::identify {

struct BoxProblem {
  // Computes the curve at u, one value per measured point; false if it cannot be evaluated. Its
  // derivatives are central differences with a step of 1e-4 to 2e-4 of the box.
  using Curve = std::function<bool(std::span<const double> u, std::span<double> values)>;

  std::size_t unknowns = 0;
  Curve curve;
  bool exact = false;                // a formula, without the errors of a scene's rows
  std::span<const double> measured;  // SI
  std::span<const double> weights;   // 1/SI: factors that make the residuals of order one
};

struct BoxMinimum {
  bool found = false;
  std::vector<double> u;
  double squares = 0.0;  // sum of the squared weighted residuals
  dense::Rows jacobian;  // their derivatives over u, one row per point; held unknowns too
  int evaluations = 0;   // of the curve
};

// Searches a local minimum from `start` by Levenberg-Marquardt within the box. Unknowns with a
// non-zero entry in `held` (empty: none) keep their values. One thread, no output, deterministic.
enum class Want { squares, slopes };  // squares: without the jacobian at the minimum
[[nodiscard]] BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                                         std::span<const char> held, Want want = Want::slopes);

// Squares and jacobian at u, without a search. `found` is false if the curve cannot be evaluated.
[[nodiscard]] BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u,
                                         Want want = Want::slopes);

// The middle of the box, then four points of Halton's sequence per unknown; always the same points.
[[nodiscard]] std::vector<std::vector<double>> search_starts(std::size_t unknowns);

struct SearchResult {
  BoxMinimum best;
  int evaluations = 0;
};

// Searches from the `searches` starts with the least squares; the first of equal minima is best.
[[nodiscard]] SearchResult search_from_several(const BoxProblem& problem, int searches);

struct Profile {
  struct Point {
    double u = 0.0;
    double squares = 0.0;
    std::vector<double> all;  // u of all unknowns
  };
  std::vector<Point> points;        // ascending u
  std::optional<double> low, high;  // u at the ends of the interval; nothing: not within the box
  int evaluations = 0;
};

// The interval of unknown `i` ends where (squares - best.squares) / sigma^2 = t^2, on each side of
// the best fit. For normal noise of unknown variance and a linear model it is Student's interval.
// `covariance` of u gives the first guesses.                             docs/theory.md [profile]
[[nodiscard]] Profile profile(const BoxProblem& problem, const BoxMinimum& best, std::size_t i,
                              const dense::Matrix& covariance, double sigma, double t);

// For an inseparable unknown: nine points, evenly over the box, without a search for the ends.
[[nodiscard]] Profile profile_over_box(const BoxProblem& problem, const BoxMinimum& best,
                                       std::size_t i);

// A direction of the box is loose, that is, not determined, if its interval at 95 % (Student's t)
// extends by more than half the box to either side. An unknown is not separately identifiable if a
// loose direction changes it by more than its error. The covariance is that of the directions which
// are determined.
struct BoxErrors {
  dense::Matrix covariance;                // of u
  dense::Matrix of_one;                    // the same of independent residuals of variance 1
  std::vector<char> inseparable;           // one per unknown
  std::vector<std::vector<double>> loose;  // unit vectors
  int determined = 0;                      // number of directions that are not loose

  [[nodiscard]] double variance(std::size_t i, std::size_t j) const {
    return covariance(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i));
  }
};
// `jacobian`: derivatives of the weighted residuals with respect to u, one row per point. `noise`:
// covariance of these residuals along the determined directions. `t`: Student's quantile. The
// `weakest` directions count as loose in any case.
//                                       docs/theory.md [interval], [loose], [sample_size]
[[nodiscard]] BoxErrors box_errors(const dense::Rows& jacobian, const dense::Matrix& noise,
                                   double t, int weakest = 0);

// The directions of the residuals, of length 1 and one row per point, along which the unknowns of a
// jacobian change them by more than 1e-6 of the steepest.
[[nodiscard]] dense::Rows determined_directions(const dense::Rows& jacobian);

// The combination of the inseparable unknowns that the data determine, if there is just one.
[[nodiscard]] std::optional<Combination> combination(const BoxErrors& errors,
                                                     std::span<const Unknown> unknowns,
                                                     std::span<const double> u, double t);

}  // namespace palpate::identify
