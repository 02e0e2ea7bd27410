// Fits relaxation and creep with a sum of exponentials (Prony series).
#pragma once

#include <span>

#include "fit/regression.h"

namespace palpate::fit {

struct PronySeries {
  enum class Kind {
    relaxation,  // y = y_inf + sum_k y_k e^(-x/tau_k)
    creep,       // y = y_0 + sum_k y_k (1 - e^(-x/tau_k))
  };
  Kind kind = Kind::relaxation;
  int terms = 2;  // 1 to 5
};

// Least squares as in regress(). Parameters: y_inf (or y_0), then y_k and tau_k > 0 in the order of
// increasing tau. Intervals are Student's, that of tau from the error of ln tau, docs/theory.md
// (92). Throws InputError for fewer than 2 * terms + 2 usable points, or if all x are equal.
[[nodiscard]] Fit fit_prony(std::span<const double> x, std::span<const double> y,
                            const PronySeries& series, const Options& options = {});

}  // namespace palpate::fit
