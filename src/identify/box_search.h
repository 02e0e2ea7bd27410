// Least squares over the box [0, 1]^n: from one start or from several, and the profile likelihood
// of one unknown, the least sum of squares for each fixed value of it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

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
  double squares = 0.0;          // sum of the squared weighted residuals
  std::vector<double> jacobian;  // their derivatives over u, one row per point; held unknowns too
  int evaluations = 0;           // of the curve
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
// `covariance` of u, row by row, gives the first guesses.                docs/theory.md [profile]
[[nodiscard]] Profile profile(const BoxProblem& problem, const BoxMinimum& best, std::size_t i,
                              std::span<const double> covariance, double sigma, double t);

// For an inseparable unknown: nine points, evenly over the box, without a search for
// the ends.
[[nodiscard]] Profile profile_over_box(const BoxProblem& problem, const BoxMinimum& best,
                                       std::size_t i);

}  // namespace palpate::identify
