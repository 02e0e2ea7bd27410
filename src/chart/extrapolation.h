// Richardson's extrapolation of a number to an infinitely fine mesh.
#pragma once

#include <span>

namespace palpate::chart {

struct Extrapolated {
  double value = 0.0;
  double error = 0.0;  // estimated, in the unit of the value, not negative
  double order = 0.0;  // observed p, from 1/2 to 3; 0 if the values show no order
};

// Fits value + C h^p to the last three of `values`, computed with decreasing `spacings` h; p is the
// observed order, but at least 1/2. The error is the correction of the finest value, but at least
// half the last change. If the values oscillate or converge faster than p = 3, the value is the
// finest one, and the error their spread. Two values are extrapolated with p = 1 and twice the
// error; one value gets an infinite error. docs/theory.md [extrapolation]
[[nodiscard]] Extrapolated extrapolate(std::span<const double> spacings,
                                       std::span<const double> values);

}  // namespace palpate::chart
