// Computes estimates, errors and R^2 of any fit from its least-squares minimum.
#pragma once

#include <span>

#include "fit/ceres_fit.h"
#include "fit/regression.h"

namespace palpate::fit {

// How the data and unknowns of a search were scaled.
struct Scaling {
  std::span<const double> y;           // scaled, of order one
  double y_scale = 1.0;                // unscaled y divided by scaled y
  std::span<const double> parameters;  // each parameter divided by its unknown in the search
  Residuals residuals = Residuals::independent;
};

// Completes a fit whose n and parameters' names are set: termination, estimates, rmse, R^2 and, if
// it has converged, the covariance (J^T J)^-1 SSE / (n - p) and Student's 95 % intervals;
// for correlated residuals the covariance and degrees of freedom of correlated.h.
void settle(Fit& fit, const Minimum& minimum, const Scaling& scaling);

}  // namespace palpate::fit
