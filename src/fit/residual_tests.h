// Tests of whether residuals are independent noise or follow a pattern.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "fit/regression.h"

namespace palpate::fit {

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
