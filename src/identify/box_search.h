// Least squares over the box [0, 1]^n.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "identify/closed_curve.h"

namespace palpate::identify {

struct BoxProblem {
  // Computes the curve at u, one value per measured point; false if it cannot be evaluated.
  using Curve = std::function<bool(std::span<const double> u, std::span<double> values)>;

  std::size_t unknowns = 0;
  Curve curve;
  // The same curve as a formula, whose derivatives are exact; null if there is none. Those of
  // `curve` are central differences with a step of 1e-4 to 2e-4 of the box.
  const ClosedCurve* closed = nullptr;
  std::span<const double> measured;  // SI
  std::span<const double> weights;   // 1/SI: factors that make the residuals of order one
};

struct BoxMinimum {
  bool found = false;
  std::vector<double> u;
  double squares = 0.0;          // sum of the squared weighted residuals
  std::vector<double> jacobian;  // their derivatives over u, one row per point; held unknowns too
  int evaluations = 0;           // of the curve
};

// Searches a local minimum from `start` by Levenberg-Marquardt within the box. Unknowns with a
// non-zero entry in `held` (empty: none) keep their values. One thread, no output, deterministic.
enum class Want { squares, slopes };  // squares: without the jacobian at the minimum
[[nodiscard]] BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                                         std::span<const char> held, Want want = Want::slopes);

// Squares and jacobian at u, without a search. `found` is false if the curve cannot be evaluated.
[[nodiscard]] BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u,
                                         Want want = Want::slopes);

}  // namespace palpate::identify
