// By how much correlated residuals widen the intervals of a search in the box.
#pragma once

#include <optional>
#include <span>

namespace palpate::identify {

struct Widening {
  double rho = 0.0;
  double effective_size = 0.0;
  double degrees = 0.0;  // of freedom, for Student's t
  double factor = 1.0;   // of the variance
};

// The geometric mean, over the directions of the box that the data determine, of the variance with
// correlated residuals over that with independent ones (fit/correlated.h). Nothing where the
// residuals are not correlated. `jacobian` as for box_errors().               docs/theory.md (105)
[[nodiscard]] std::optional<Widening> widening(std::span<const double> residuals,
                                               std::span<const double> jacobian,
                                               std::size_t unknowns);

}  // namespace palpate::identify
