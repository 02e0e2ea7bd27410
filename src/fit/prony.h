// Fits relaxation and creep with a sum of exponentials (Prony series).
#pragma once

#include <span>

#include "fit/prony_basis.h"
#include "fit/regression.h"

namespace palpate::fit {

struct PronySeries {
  enum class Kind {
    relaxation,  // y = y_inf + sum_k y_k e^(-x/tau_k)
    creep,       // y = y_0 + sum_k y_k (1 - e^(-x/tau_k))
  };
  Kind kind = Kind::relaxation;
  int terms = 2;                // 1 to 5 with free times; above, the times are given
  bool liquid = false;          // relaxation to 0; creep that goes on: y_flow times the time
  LoadingHistory history = {};  // with a ramp, phi_k(x) of prony_basis.h replaces e^(-x/tau_k)
};

constexpr int most_free_terms = 5;
constexpr int most_terms = 60;

// Least squares as in regress(). Parameters: y_inf (or y_0), then y_k and tau_k > 0 in the order of
// increasing tau. A liquid has no y_inf in relaxation, and in creep y_flow after y_0, the rate of
// y_0 + y_flow int H dx + sum (Burgers 1935 with one term). Intervals are Student's, that of tau
// from the error of ln tau, docs/theory.md [prony]. With more than 5 terms, the times are spaced
// evenly in their logarithm from the distance of two points to the length of the record, and the
// y_k >= 0 follow by non-negative least squares, without intervals; terms of 0 are excluded. Values
// refer to the largest of the history. Throws InputError for fewer than 2 * terms + 2 usable points
// (terms + 2 if the times are given), if all x are equal, and for a history whose times do not
// ascend.
[[nodiscard]] Fit fit_prony(std::span<const double> x, std::span<const double> y,
                            const PronySeries& series, const Options& options = {});

}  // namespace palpate::fit
