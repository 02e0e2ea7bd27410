// Standard errors and correlations of the unknowns at a minimum, and which of them are not
// separately identifiable.
#pragma once

#include <span>
#include <vector>

#include "identify/identify.h"

namespace palpate::identify {

// A direction of the box is loose, that is, not determined, if its interval at 95 % (Student's t)
// extends by more than half the box to either side. An unknown is not separately identifiable if a
// loose direction changes it by more than its error. The covariance is that of the directions which
// are determined.
struct BoxErrors {
  std::vector<double> covariance;          // of u, row by row
  std::vector<double> of_one;              // the same of independent residuals of variance 1
  std::vector<char> inseparable;           // one per unknown
  std::vector<std::vector<double>> loose;  // unit vectors
  int determined = 0;                      // number of directions that are not loose

  [[nodiscard]] double variance(std::size_t i, std::size_t j) const {
    return covariance[i * inseparable.size() + j];
  }
};
// `jacobian`: derivatives of the weighted residuals with respect to u, one row per point. `noise`:
// covariance of these residuals along the determined directions, by rows. `t`: Student's quantile.
// The `weakest` directions count as loose in any case.
//                                       docs/theory.md [interval], [loose], [sample_size]
[[nodiscard]] BoxErrors box_errors(std::span<const double> jacobian, std::size_t unknowns,
                                   std::span<const double> noise, double t, int weakest = 0);

// The directions of the residuals, of length 1 and one row per point, along which the unknowns of a
// jacobian change them by more than 1e-6 of the steepest.
[[nodiscard]] std::vector<double> determined_directions(std::span<const double> jacobian,
                                                        std::size_t unknowns);

// The combination of the inseparable unknowns that the data determine; nothing
// unless there is just one.
[[nodiscard]] std::optional<Combination> combination(const BoxErrors& errors,
                                                     std::span<const Unknown> unknowns,
                                                     std::span<const double> u, double t);

}  // namespace palpate::identify
