// Least squares: a curve through measured points, with the errors of its parameters.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fit/model.h"

namespace palpate::fit {

enum class Termination {
  converged,
  not_converged,  // out of iterations; estimates are the last ones, errors are NaN
  undetermined,   // a minimum, but the data do not fix every parameter; errors are NaN
  failed,         // the curve cannot be evaluated on these data; all numbers are NaN
};

// The word of fits.csv.
[[nodiscard]] std::string_view word(Termination termination);

struct Estimate {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string name = {};
  std::string unit = {};
  double initial = unknown;  // where the search began
  double estimate = unknown;
  double std_error = unknown;
  double ci95_low = unknown;
  double ci95_high = unknown;
};

struct Fit {
  Model model = Model::logarithmic;
  std::string name =
      {};  // of a curve beyond the table of models (`hertz`, `prony`); empty: its own
  std::vector<Estimate> parameters = {};  // in the order of info(model)
  std::vector<double> covariance = {};    // of the estimates, row by row; empty where not known
  double r2 = Estimate::unknown;          // 1 - SSE / SST about the mean; NaN where y is constant
  double rmse = Estimate::unknown;        // sqrt(SSE / n), in y's unit
  int n = 0;                              // points used
  int left_out = 0;  // points that are not finite, or x <= 0 where ln x is needed
  double range_low = Estimate::unknown;  // of the x used, as given
  double range_high = Estimate::unknown;
  double x_origin = 0.0;  // the curve is a function of (x - x_origin)
  int iterations = 0;
  Termination termination = Termination::failed;
};

struct Options {
  std::string x_unit = {};  // for the parameters' units, as column_unit gives them
  std::string y_unit = {};
  double x_origin = 0.0;  // subtracted from every x: when the load was applied or withdrawn
  int max_iterations = 200;
};

// Fits `model` to the points (x[i], y[i]) by minimising the sum of squared residuals in y.
// Deterministic. Intervals are Student's t for n - p degrees with the covariance
// (J^T J)^-1 SSE / (n - p). Both spans have the same size, in any consistent units. Throws
// InputError where fewer usable points are left than parameters + 1. Never writes to the terminal.
[[nodiscard]] Fit regress(std::span<const double> x, std::span<const double> y, Model model,
                          const Options& options = {});

// The fitted curve at x, as given (x_origin is subtracted here).
[[nodiscard]] double value(const Fit& fit, double x);

// The version of the Ceres library, as `2.1.0`.
[[nodiscard]] std::string ceres_version();

}  // namespace palpate::fit
