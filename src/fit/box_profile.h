// The profile likelihood of one unknown: the least squares that are left where it is held.
#pragma once

#include <optional>
#include <vector>

#include "fit/box_search.h"

namespace palpate::fit {

struct Profile {
  struct Point {
    double u = 0.0;
    double squares = 0.0;
  };
  std::vector<Point> points;        // ascending u
  std::optional<double> low, high;  // u where it leaves the interval; nothing: not within the box
  int evaluations = 0;
};

// Where (squares - best.squares) / sigma^2 passes t^2, on both sides of the best fit: for normal
// noise of unknown variance and a linear model the same interval as Student's t. `covariance` is
// that of u, row by row.
[[nodiscard]] Profile profile(const BoxProblem& problem, const BoxMinimum& best, std::size_t i,
                              std::span<const double> covariance, double sigma, double t);

// Of an unknown that is tied: evenly over the box, without a search for ends.
[[nodiscard]] Profile profile_over_box(const BoxProblem& problem, const BoxMinimum& best,
                                       std::size_t i);

}  // namespace palpate::fit
