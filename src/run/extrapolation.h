// What a number would be on an endlessly fine mesh, from the numbers of a few.
#pragma once

#include <span>

namespace palpate::run {

struct Extrapolated {
  double value = 0.0;
  double error = 0.0;  // of the value, estimated; of its unit, not negative
  double order = 0.0;  // observed, within its bounds; 0 where the numbers do not settle
};

// Richardson's extrapolation of the last three of `values`, found with `spacings` that fall: as
// value + C h^p through them, with the p that they show, 1/2 where it is less. The error is what
// that adds to the finest value, and at least half the last change. Values that swing, or approach
// each other faster than with p = 3, tell no order: then the finest one, and their spread as error.
// Of two values as if p = 1, and twice the error; of one nothing is known.  docs/theory.md (78)
[[nodiscard]] Extrapolated extrapolate(std::span<const double> spacings,
                                       std::span<const double> values);

}  // namespace palpate::run
