// Standard errors of a least-squares fit whose residuals are correlated from row to row.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace palpate::fit {

// What residuals say of the errors of the unknowns.
struct ResidualErrors {
  double rho = 0.0;                // correlation of neighbours, 0 to 0.999; 0 if independent
  double degrees = 0.0;            // of freedom, for Student's t
  std::vector<double> covariance;  // of the unknowns, by rows
  // Geometric mean of their variances over those of independent residuals: n rows are worth n over
  // this many independent ones.
  double factor = 1.0;
};

// The errors of a least-squares fit, with `inverse` = (J^T J)^-1 by rows: the covariance for
// independent residuals, or for correlated ones as below, and the part of rounding `records` to
// steps. The records, one after the other, are the values that were fitted, in the scale of the
// residuals; residuals below 1e-9 count as independent.
[[nodiscard]] ResidualErrors errors_of(std::span<const double> residuals,
                                       std::span<const double> jacobian,
                                       std::span<const double> inverse,
                                       std::span<const std::span<const double>> records);

// rho by restricted maximum likelihood, which takes the fitted unknowns into account, and the
// covariance of the ordinary estimates, with the 95 % intervals of white noise with slow noise of
// many kinds, each by its likelihood. `jacobian` has one row of `unknowns` derivatives per
// residual, in the order of time. Nothing if the likelihood ratio against independent residuals is
// below 2.71 (5 %, one-sided), for fewer than 20 residuals, and if the jacobian lacks full rank.
//   docs/theory.md [correlated], [covariance], [slow_noise]; Harville 1977, J. Am. Stat. Assoc. 72
[[nodiscard]] std::optional<ResidualErrors> autocorrelation(std::span<const double> residuals,
                                                            std::span<const double> jacobian,
                                                            std::size_t unknowns);

}  // namespace palpate::fit
