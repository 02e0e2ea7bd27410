// The profile likelihood of one unknown: the least sum of squares for each fixed value of it.
#pragma once

#include <optional>
#include <vector>

#include "identify/box_search.h"

namespace palpate::identify {

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
