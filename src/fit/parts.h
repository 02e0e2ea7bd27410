// Finds where the parts of a record begin and end: the loading of a test between platens or grips,
// its cycles, where the specimen fails or a sensor ends; and the step of a relaxation, creep or
// recovery.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

// Neighbouring rows [from, to) over which x goes one way, up or down, by more than its scatter.
struct Branch {
  std::size_t from = 0, to = 0;
  bool up = true;
};

// The branches between the turns of x. A turn counts if x goes back by more than `share` of its
// range.
[[nodiscard]] std::vector<Branch> branches_of(std::span<const double> x, double share = 0.1);

// The number of rows up to the largest stress before its first fall by more than `share` of its
// rise until then and more than six deviations of its noise; all rows where it does not fall. A
// fall that is followed by no rise beyond it is a rupture, any other one a partial failure.
[[nodiscard]] std::size_t rows_before_fall(std::span<const double> stress, double share = 0.1);

enum class Way { approach, retract, all };

// The rows of one way of a curve that goes in and out: up to its first turn within a tenth of the
// range of the deepest one, or from there to the next turn; all rows of other curves.
struct OneWay {
  std::size_t from = 0, to = 0;
  std::size_t loadings = 0;  // that reach so deep
};
[[nodiscard]] OneWay one_way(std::span<const double> depth, Way way);

// The rows [from, to) at which y stays at exactly its largest value, as at the limit of a sensor:
// five or more, over three times as many as stay at any of the two values before and after. Empty
// where there are none.
struct Limit {
  std::size_t from = 0, to = 0;
};
[[nodiscard]] Limit limit_of(std::span<const double> y);

// The number of rows of a loading up to the largest force, where those beyond are lower on average
// by more than a tenth of its rise and four deviations of its noise: the specimen gave way.
// Otherwise all rows.
[[nodiscard]] std::size_t rows_before_break(std::span<const double> force);

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

// The median; of an even number of values the larger of the two in the middle. At least one.
[[nodiscard]] double median(std::vector<double> values);

// The means of neighbouring values in so many blocks, which are no more than the values.
[[nodiscard]] std::vector<double> block_means(std::span<const double> values, std::size_t blocks);

// The standard deviation of white noise in y, from its second differences (median, so that steps
// do not count); 0 for fewer than 5 values.
[[nodiscard]] double noise_of(std::span<const double> y);

}  // namespace palpate::fit
