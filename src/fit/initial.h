// Where a search begins: the best of a fixed grid of shapes, each with its own linear fit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/model.h"

namespace palpate::fit {

// Parameters near the least-squares fit, in the order of info(model): for every shape q of a grid
// (n, or m and tau in units of the largest |x|) the curve is linear in the rest and solved by QR;
// the smallest sum of squares wins, the first of equals. Nothing where no shape can be evaluated.
// x and y are finite and of one size.
[[nodiscard]] std::optional<std::vector<double>> initial_guess(std::span<const double> x,
                                                               std::span<const double> y,
                                                               Model model);

}  // namespace palpate::fit
