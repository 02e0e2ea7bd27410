// Relaxation and creep by a sum of exponentials, as many as are asked for.
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

// Least squares as by regress(). Parameters: y_inf (or y_0), then y_k and tau_k > 0 by rising tau.
// Intervals are Student's, of tau by its slope. Throws InputError where fewer than 2 terms + 2
// points are usable.
[[nodiscard]] Fit fit_prony(std::span<const double> x, std::span<const double> y,
                            const PronySeries& series, const Options& options = {});

}  // namespace palpate::fit
