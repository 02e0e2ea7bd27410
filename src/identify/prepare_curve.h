// Prepares a measurement for the search: points, weights, and the curve of one model.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "identify/identify.h"

namespace palpate::identify {

struct PreparedCurve {
  Identification found;  // the curve, its model and points, and what was excluded, before a search
  std::unique_ptr<ScenarioCurve> curve = nullptr;
  std::vector<double> weights = {};  // of the residuals, 1/SI
  double rows_each = 1.0;            // largest number of rows of which a point is the mean
};

// Throws InputError like identify(). `family` and `unknowns` must outlive the result.
[[nodiscard]] PreparedCurve prepare_curve(const Measurement& measured,
                                          const scenario::Family& family,
                                          const std::vector<Unknown>& unknowns, Noise noise);

constexpr std::size_t most_rows = 6000;  // longer records are averaged

struct AveragedRows {
  std::vector<double> x, y;   // means, in the order of the rows
  std::vector<double> count;  // rows of each block
};

// Means of neighbouring rows in 1500 blocks, of which those are halved again and again within
// which y is no straight line over the rows: where its mean in the middle half differs from that in
// the outer quarters by more than four standard errors and 1e-4 of the range. For white noise
// nothing is lost.                                                     docs/theory.md [averages]
[[nodiscard]] AveragedRows averaged(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace palpate::identify
