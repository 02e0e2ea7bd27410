// The initial guess of a fit: the best of a fixed grid of shape parameters.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/model.h"

namespace palpate::fit {

// Returns parameters near the least-squares fit, in the order of info(model). For every shape q of
// a grid (n, or m and tau scaled with the largest |x|) the other parameters are linear and solved
// for by QR; the smallest sum of squares wins (the first, if several are equal). Nothing if no
// shape can be evaluated. x and y must be finite and of equal size.
[[nodiscard]] std::optional<std::vector<double>> initial_guess(std::span<const double> x,
                                                               std::span<const double> y,
                                                               Model model);

}  // namespace palpate::fit
