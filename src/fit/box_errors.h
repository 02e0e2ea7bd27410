// What slopes at a minimum say of the unknowns: errors, correlations, and which of them are tied.
#pragma once

#include <span>
#include <vector>

#include "fit/identify.h"

namespace palpate::fit {

// Of the residuals' slopes over u (row by row, one a point), whose noise has the standard deviation
// `sigma` in their units. A direction of the box that the data do not narrow down to less than half
// of it, at 95 % with Student's t, is not determined. An unknown is tied where such a direction
// moves it by more than its own error. Others have the covariance that the determined directions
// leave.                                             equations: docs/identify.md
struct BoxErrors {
  std::vector<double> covariance;  // of u, row by row
  std::vector<char> tied;
  std::vector<std::vector<double>> loose;  // unit directions that are not determined
  int determined = 0;                      // directions

  [[nodiscard]] double variance(std::size_t i, std::size_t j) const {
    return covariance[i * tied.size() + j];
  }
};
[[nodiscard]] BoxErrors box_errors(std::span<const double> jacobian, std::size_t unknowns,
                                   double sigma, double t);

// What the data determine of unknowns that are tied to each other: nothing where it takes more than
// one number to say.
[[nodiscard]] std::optional<Combination> combination(const BoxErrors& errors,
                                                     std::span<const Unknown> unknowns,
                                                     std::span<const double> u, double t);

}  // namespace palpate::fit
