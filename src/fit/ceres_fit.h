// One least-squares problem, given to Ceres; no type of Ceres crosses this header.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/model.h"

namespace palpate::fit {

// Ceres speaks through glog whatever its own options say; from the first call on it is silent.
void silence_glog();

struct Minimum {
  enum class Status { found, out_of_iterations, failed };

  Status status = Status::failed;
  std::vector<double> parameters;
  double squares = 0.0;  // the sum of squared residuals
  int iterations = 0;
  // (J^T J)^-1 at the minimum, row by row; empty where J has not full rank, or nothing was found.
  std::vector<double> inverse_normal;
};

// A curve at all of its points for some parameters: one value a point and, where `slopes` is not
// empty, the derivatives by the parameters, a row a point. False where it cannot be evaluated.
using CurveAt = std::function<bool(std::span<const double> parameters, std::span<double> values,
                                   std::span<double> slopes)>;

// Minimises sum (value_i - y_i)^2 from `start` by Levenberg-Marquardt. y is of order one: the
// stopping tolerances are absolute. Writes nothing to the terminal and no log file.
[[nodiscard]] Minimum minimise(std::span<const double> y, const CurveAt& curve,
                               std::span<const double> start, int max_iterations);

// The same of a model's curve over x, by the derivatives of terms().
[[nodiscard]] Minimum minimise(std::span<const double> x, std::span<const double> y, Model model,
                               std::span<const double> start, int max_iterations);

}  // namespace palpate::fit
