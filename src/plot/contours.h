// Contour lines of values on a grid.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::plot {

// About `wanted` round numbers from `low` to `high`. Linear: multiples of 1, 2 or 5 times a power
// of ten. Logarithmic: 1, 2 and 5 of each decade, or only 1 if these are more than twice `wanted`.
[[nodiscard]] std::vector<double> round_levels(double low, double high, std::size_t wanted,
                                               bool logarithmic);

struct Segment {
  double level = 0.0;
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

// Values over increasing x and y: values[j * x.size() + i] belongs to (x[i], y[j]); NaN if unknown.
struct ValueGrid {
  std::vector<double> x, y, values;
};

// The contour lines of these levels (marching squares): straight segments in each cell of four grid
// points, between points interpolated linearly along its edges. Cells with an unknown corner have
// none. In a cell with four crossings the mean of the corners decides which ones are connected.
[[nodiscard]] std::vector<Segment> contours(const ValueGrid& grid, std::span<const double> levels);

}  // namespace palpate::plot
