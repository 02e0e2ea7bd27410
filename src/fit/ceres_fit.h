// Least-squares problems solved by Ceres; no type of Ceres appears in this header.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

struct Minimum {
  enum class Status { found, out_of_iterations, failed };

  Status status = Status::failed;
  std::vector<double> parameters;
  double squares = 0.0;  // sum of squared residuals
  // (J^T J)^-1 at the minimum, by rows; empty if J lacks full rank or no minimum was found.
  std::vector<double> inverse_normal;
  // At the minimum: value_i - y_i, and its derivatives, one row per point; empty if none was found.
  std::vector<double> residuals = {};
  std::vector<double> jacobian = {};
};

// Computes a curve for given parameters: one value per point and, unless `slopes` is empty, the
// derivatives with respect to the parameters, one row per point. False if this is impossible.
using CurveAt = std::function<bool(std::span<const double> parameters, std::span<double> values,
                                   std::span<double> slopes)>;

// How far and how exactly to search. Each parameter is in units of its start's size.
struct Descent {
  int max_iterations = 200;
  double low =
      -std::numeric_limits<double>::infinity();  // bounds of every parameter, in its own unit
  double high = std::numeric_limits<double>::infinity();
  // Unknowns, residuals and slopes are of order one, so that a gradient of 1e-14 per point leaves
  // an error of about 1e-14. The cost stops changing (to 1e-16) long before that.
  double gradient_tolerance = 1e-14;  // per point
  double parameter_tolerance = 1e-14;
  double function_tolerance = 0.0;
  bool errors = true;  // false: without residuals, jacobian and inverse_normal at the minimum
};

// Minimises sum (value_i - y_i)^2 from `start` by Levenberg-Marquardt. The stopping tolerances are
// absolute: scale y to order one. Writes nothing to the terminal and no log file.
[[nodiscard]] Minimum minimise(std::span<const double> y, const CurveAt& curve,
                               std::span<const double> start, const Descent& search);

// The same for the curve of `model` over x, with the derivatives of slopes().
[[nodiscard]] Minimum minimise(std::span<const double> x, std::span<const double> y, Model model,
                               std::span<const double> start, int max_iterations);

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
