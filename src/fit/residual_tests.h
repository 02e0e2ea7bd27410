// Whether residuals are noise, or the curve's own fault.
#pragma once

#include <span>

namespace palpate::fit {

// sum (e_i - e_(i-1))^2 / sum e_i^2, about 2 of independent residuals and towards 0 where
// neighbours agree.                                        Durbin and Watson 1950, Biometrika 37
[[nodiscard]] double durbin_watson(std::span<const double> residuals);

// The number of runs of one sign, less its mean, in standard deviations of independent signs; far
// below 0 where residuals keep their sign for long.          Wald and Wolfowitz 1940
[[nodiscard]] double runs_z(std::span<const double> residuals);

// Both say at a level of 1 in 1000 that neighbours agree.
[[nodiscard]] bool systematic(std::span<const double> residuals);

}  // namespace palpate::fit
