// The solution of a layer's equation for a given depth.
#pragma once

#include <cmath>

#include "contact/layer_integral.h"

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

}  // namespace palpate::test
