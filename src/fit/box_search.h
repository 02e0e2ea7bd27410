// Least squares over the box [0, 1]^n, given to Ceres; no type of Ceres crosses this header.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fit/closed_curve.h"

namespace palpate::fit {

// How slopes are found: of a closed form by Ceres's automatic differentiation, else by central
// differences of a ten-thousandth of the box or by Ridders's extrapolation.
enum class Slopes { automatic, central, ridders };

struct BoxProblem {
  // The curve at u, one value a measured point; false where it cannot be evaluated.
  using Curve = std::function<bool(std::span<const double> u, std::span<double> values)>;

  std::size_t unknowns = 0;
  Curve curve;
  const ClosedCurve* closed = nullptr;  // the same curve as a formula, where there is one
  Slopes slopes = Slopes::automatic;    // automatic without `closed` is central
  std::span<const double> measured;
  std::span<const double> weights;  // of the residuals, so that these are of order one
};

struct BoxMinimum {
  bool found = false;
  std::vector<double> u;
  double squares = 0.0;          // of the weighted residuals
  std::vector<double> jacobian;  // of these over u, row by row, a row a point; held ones too
  int evaluations = 0;           // of the curve
};

// The nearest minimum from `start`, by Levenberg-Marquardt within the box. Unknowns of `held` keep
// their values. Serial and silent; deterministic.
enum class Want { squares, slopes };  // squares: without the jacobian at the minimum
[[nodiscard]] BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                                         std::span<const char> held, Want want = Want::slopes);

// Residuals and slopes at u, without a search. Not found where the curve cannot be evaluated.
[[nodiscard]] BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u,
                                         Want want = Want::slopes);

}  // namespace palpate::fit
