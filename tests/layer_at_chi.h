// The solution of a layer's equation for a given depth, and what follows from a solution.
#pragma once

#include <cmath>
#include <numbers>

#include "contact/layer.h"

namespace palpate::test {

// By Newton's method to rounding: chi grows almost linearly with the ratio a/H.
inline contact::LayerSolution layer_at_chi(const contact::LayerEquation& equation, double chi) {
  contact::LayerSolution solution = equation.solve(chi);
  for (int pass = 0; pass < 20; ++pass) {
    const double change = (chi - solution.chi) / solution.chi_slope;
    if (std::abs(change) <= 1e-14 * chi) break;
    solution = equation.solve(solution.ratio + change);
    if (std::abs(change) < 1e-8 * chi) break;  // the next error is about change^2
  }
  return solution;
}

// One solution with the resolution that the ratio a/H needs.
inline contact::LayerSolution solve_layer(double ratio, const contact::Layer& layer) {
  return contact::LayerEquation(layer, contact::layer_resolution(ratio / layer.top())).solve(ratio);
}

// kappa of a rigid flat punch of radius a = ratio H: F = 2 a E* h kappa. At least 1 on one layer.
inline double flat_punch_factor(double ratio, const contact::Layer& layer) {
  return solve_layer(ratio, layer).punch;
}

// c_1 of F / F_Hertz = 1 + c_1 chi + 7/6 c_1^2 chi^2 + ..., the thickness to first order:
//   c_1 = 2/pi share int_0^inf M(u) du                           docs/theory.md [layer_series]
inline double layer_first_coefficient(const contact::Layer& layer) {
  double sum = 0.0;
  const int count = layer.below.empty() ? 64 : 256;
  for (const contact::LayerWave& wave : contact::layer_waves(layer, count)) sum += wave.missing;
  return 2.0 / std::numbers::pi * sum;
}

}  // namespace palpate::test
