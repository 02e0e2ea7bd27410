// What residuals say: whether they are independent noise or follow a pattern, and the standard
// errors of a least-squares fit whose residuals are correlated from row to row.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

// What residuals say of the errors of the unknowns.
struct ResidualErrors {
  double rho = 0.0;          // correlation of neighbours, 0 to 0.999; 0 if independent
  double degrees = 0.0;      // of freedom, for Student's t
  dense::Matrix covariance;  // of the unknowns
  // Geometric mean of their variances over those of independent residuals: n rows are worth n over
  // this many independent ones.
  double factor = 1.0;
};

// The errors of a least-squares fit, with `inverse` = (J^T J)^-1: the covariance for
// independent residuals, or for correlated ones as below, and the part of rounding `records` to
// steps. The records, one after the other, are the values that were fitted, in the scale of the
// residuals; residuals below 1e-9 count as independent.
[[nodiscard]] ResidualErrors errors_of(std::span<const double> residuals,
                                       const dense::Rows& jacobian, const dense::Matrix& inverse,
                                       std::span<const std::span<const double>> records);

// rho by restricted maximum likelihood, which takes the fitted unknowns into account, and the
// covariance of the ordinary estimates, with the 95 % intervals of white noise with slow noise of
// many kinds, each by its likelihood. `jacobian` has one row of derivatives per residual, in the
// order of time. Nothing if the likelihood ratio against independent residuals is
// below 2.71 (5 %, one-sided), for fewer than 20 residuals, and if the jacobian lacks full rank.
//   docs/theory.md [correlated], [covariance], [slow_noise]; Harville 1977, J. Am. Stat. Assoc. 72
[[nodiscard]] std::optional<ResidualErrors> autocorrelation(std::span<const double> residuals,
                                                            const dense::Rows& jacobian);

// sum (e_i - e_(i-1))^2 / sum e_i^2: about 2 for independent residuals, near 0 if neighbours are
// correlated.                                              Durbin and Watson 1950, Biometrika 37
[[nodiscard]] double durbin_watson(std::span<const double> residuals);

// (number of runs of equal sign - its mean) / its standard deviation, both for independent signs;
// far below 0 if residuals keep their sign for long.                        Wald and Wolfowitz 1940
[[nodiscard]] double runs_z(std::span<const double> residuals);

// Whether both tests, each at a level of 1 in 1000, find neighbours correlated; false below 10.
[[nodiscard]] bool systematic(std::span<const double> residuals);

// What correlated residuals say of a fit to so many points, which are worth `effective` independent
// ones: slow noise and a law that does not fit look alike.
[[nodiscard]] std::string correlation_sentence(double durbin_watson, std::size_t points,
                                               double effective);

// Adds sentences on R^2 below 0.9 and on correlated residuals to fit.warnings.
void warn_of_residuals(Fit& fit);

}  // namespace palpate::fit
