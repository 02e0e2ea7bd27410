// The moment of the step in a curve of relaxation, creep or recovery.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

// When the load steps, or begins to rise at a constant rate for the time `ramp`. In the unit of x.
struct Loading {
  double time = 0.0;
  double ramp = 0.0;
  double first = -std::numeric_limits<double>::infinity();  // rows before it are none of the curve
};

struct StepOrigin {
  Loading best = {};
  std::string sentence = {};  // what it was found from; empty: the clock's zero, as it stands
  // The others between which the rows leave the loading open: what they change belongs to the
  // errors of every parameter. None where the clock's zero counts.
  std::vector<Loading> others = {};
  bool after_level = false;  // rows of a level lie before a rise, so that refined() can do better
};

enum class AfterStep {
  relaxes,          // y is largest at the step, or at the end of a ramp
  recovers,         // y is largest at the step; creep may lie before it
  rises,            // creep with an instantaneous part
  rises_from_zero,  // creep without one: y is 0 at the step
};

// The step of y(x), with the shape that y has after it. Where y is largest, or where it leaves its
// first level (rises), rows before that moment lie before the step. The clock's zero is the step
// where it lies within one row's distance of it, and where the times are spaced by a constant
// factor; otherwise the step is at that row. `ramp` is the duration of a loading ramp that ends at
// the largest value: the origin is its start. Without a number it is found, if the rows of a
// relaxation show one. Throws InputError for a creep from zero whose first row is not near zero,
// since it began before the record.                               docs/theory.md [time_origin]
[[nodiscard]] StepOrigin step_origin(std::span<const double> x, std::span<const double> y,
                                     AfterStep shape, std::optional<double> ramp);

// A rise after a level begins where the sum of squares about the level's mean before and about the
// fit after it is least. `squares` computes that of the fit to the rows from a moment on, with the
// moment as the origin, and how many rows count as an independent one; nothing if it cannot. The
// others are the ends of the range in which the sum is within Student's interval at 95 %.
//                                                                 docs/theory.md [time_origin]
struct Misfit {
  double squares = 0.0;
  double rows_each = 1.0;
  int parameters = 0;
};
[[nodiscard]] std::optional<Misfit> misfit_of(const std::function<Fit()>& fit);
[[nodiscard]] StepOrigin refined(
    const StepOrigin& coarse, std::span<const double> x, std::span<const double> y,
    const std::function<std::optional<Misfit>(const Loading& loading)>& fit_after);

// The number of rows of a creep up to the corner at which it begins to recover: before the first
// three rows in a row (or as many as are left) that lie below the largest y until then by more than
// a quarter of its rise and six deviations of the noise. All rows where there are none.
[[nodiscard]] std::size_t rows_before_recovery(std::span<const double> x,
                                               std::span<const double> y);

// The standard deviation of white noise in y, from its second differences (median, so that steps
// do not count); 0 for fewer than 5 values.
[[nodiscard]] double noise_of(std::span<const double> y);

}  // namespace palpate::fit
