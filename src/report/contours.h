// Lines of equal value on a grid of values, as plots draw them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace palpate::report {

// Round numbers from `low` to `high`, about `wanted` of them: 1, 2 and 5 of each decade, or decades
// alone where these are too many.
[[nodiscard]] std::vector<double> round_levels(double low, double high, std::size_t wanted,
                                               bool logarithmic);

struct Segment {
  double level = 0.0;
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

// A grid of values over x and y, both rising; values[j * x.size() + i] stands at (x[i], y[j]), no
// number where nothing is known.
struct ValueGrid {
  std::vector<double> x, y, values;
};

// The pieces of the lines of these levels, straight within each cell of four neighbours, by linear
// interpolation along its edges; none in a cell with a corner that is not known. A cell that has
// four crossings is cut as the mean of its corners says.
[[nodiscard]] std::vector<Segment> contours(const ValueGrid& grid, std::span<const double> levels);

}  // namespace palpate::report
