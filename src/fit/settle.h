// What a least-squares minimum says of its parameters, whatever the curve.
#pragma once

#include <span>

#include "fit/ceres_fit.h"
#include "fit/regression.h"

namespace palpate::fit {

// How a search was scaled.
struct Scaling {
  std::span<const double> y;           // of the search, of order one
  double y_scale = 1.0;                // the fit's rmse over the search's
  std::span<const double> parameters;  // each parameter over its unknown of the search
};

// A minimum into a fit whose n and parameters' names are set: how it ended, estimates, rmse, R^2
// (1 - SSE / SST about the mean; NaN where y is constant), and, where it converged, the covariance
// (J^T J)^-1 SSE / (n - p) with Student's 95 % intervals.
void settle(Fit& fit, const Minimum& minimum, const Scaling& scaling);

}  // namespace palpate::fit
