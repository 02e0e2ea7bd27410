// Least-squares problems solved by Ceres, of curves that are linear in some of their parameters
// too; no type of Ceres appears in this header.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

struct Minimum {
  enum class Status { found, out_of_iterations, failed };

  Status status = Status::failed;
  std::vector<double> parameters;
  double squares = 0.0;  // sum of squared residuals
  // (J^T J)^-1 at the minimum; empty if J lacks full rank or no minimum was found.
  dense::Matrix inverse_normal;
  // At the minimum: value_i - y_i, and its derivatives, one row per point; empty if none was found.
  std::vector<double> residuals = {};
  dense::Rows jacobian = {};
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
// for correlated residuals the covariance and degrees of freedom of residuals.h.
void settle(Fit& fit, const Minimum& minimum, const Scaling& scaling);

// y_i = sum_j c_j phi_ij(s): linear in the factors c, non-linear in the shapes s.
struct Separable {
  std::size_t linear = 1;  // number of factors
  // Computes phi at these shapes, one row of `linear` numbers per point; false if it cannot.
  std::function<bool(std::span<const double> shapes, std::span<double> phi)> columns;
  std::vector<std::vector<double>> starts;  // shapes, each with its best factors; the best is taken
  // 1 or more: of so many of the best starts the nearest minima are compared first.
  std::size_t minima = 0;
};

// The best of `starts`, by linear least squares for c, and from there a minimum over all of them.
// The parameters are c, then s; derivatives with respect to s are central differences. Scale y and
// the shapes to order one. Failed where no start can be computed.
[[nodiscard]] Minimum minimise(std::span<const double> y, const Separable& curve,
                               int max_iterations);

// Replaces parameter i by `value`, whose derivative with respect to the parameter is `slope`.
void replace_parameter(Minimum& minimum, Eigen::Index i, double value, double slope);

// Errors of parameter i that has become p_i + factor p_j, to first order.
void add_to_parameter(Minimum& minimum, Eigen::Index i, Eigen::Index j, double factor);

// Parameter k becomes that which was parameter from[k].
void reorder_parameters(Minimum& minimum, std::span<const std::size_t> from);

}  // namespace palpate::fit
