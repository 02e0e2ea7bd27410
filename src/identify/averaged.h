// Rows of a long record as means of blocks, for searches whose cost grows with the rows.
#pragma once

#include <cstddef>
#include <vector>

namespace palpate::identify {

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
