// Standard errors of a least-squares fit whose residuals are correlated from row to row.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace palpate::fit {

// Residuals whose neighbours correlate.
struct Autocorrelation {
  double rho = 0.0;                // correlation of neighbours, 0 to 0.999
  double degrees = 0.0;            // of freedom, for Student's t
  double effective_size = 0.0;     // independent rows whose mean is as well known
  std::vector<double> covariance;  // of the unknowns, by rows: the sandwich of docs/theory.md (101)
};

// rho by restricted maximum likelihood, which takes the fitted unknowns into account, and the
// covariance of the ordinary estimates, with the 95 % intervals of white noise with slow noise of
// many kinds, each by its likelihood. `jacobian` has one row of `unknowns` derivatives per
// residual, in the order of time. Nothing if the likelihood ratio against independent residuals is
// below 2.71 (5 %, one-sided), for fewer than 20 residuals, and if the jacobian lacks full rank.
//                        docs/theory.md (100), (101), (118); Harville 1977, J. Am. Stat. Assoc. 72
[[nodiscard]] std::optional<Autocorrelation> autocorrelation(std::span<const double> residuals,
                                                             std::span<const double> jacobian,
                                                             std::size_t unknowns);

// The covariance that rounding to steps adds: rows of one step in a row share one error, uniform
// over the step. `values` are those that were fitted, `inverse` is (J^T J)^-1. Empty where they are
// not multiples of a step, or differ from row to row.                        docs/theory.md (119)
[[nodiscard]] std::vector<double> quantised_covariance(std::span<const double> values,
                                                       std::span<const double> jacobian,
                                                       std::span<const double> inverse);

}  // namespace palpate::fit
