// Least-squares problems solved by Ceres; no type of Ceres appears in this header.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/model.h"

namespace palpate::fit {

// Ceres logs through glog even if its options say otherwise; this call silences glog.
void silence_glog();

struct Minimum {
  enum class Status { found, out_of_iterations, failed };

  Status status = Status::failed;
  std::vector<double> parameters;
  double squares = 0.0;  // sum of squared residuals
  int iterations = 0;
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

// Minimises sum (value_i - y_i)^2 from `start` by Levenberg-Marquardt. The stopping tolerances are
// absolute: scale y to order one. Writes nothing to the terminal and no log file.
[[nodiscard]] Minimum minimise(std::span<const double> y, const CurveAt& curve,
                               std::span<const double> start, int max_iterations);

// The same for the curve of `model` over x, with the derivatives of slopes().
[[nodiscard]] Minimum minimise(std::span<const double> x, std::span<const double> y, Model model,
                               std::span<const double> start, int max_iterations);

}  // namespace palpate::fit
