// The moment of the step in a curve of relaxation, creep or recovery.
#pragma once

#include <limits>
#include <span>
#include <string>

namespace palpate::fit {

struct StepOrigin {
  double time = 0.0;     // in the unit of x
  std::string sentence;  // what it was found from; empty: the clock's zero, as it stands
  double first = -std::numeric_limits<double>::infinity();  // rows before it are before the step
};

enum class AfterStep {
  falls,            // relaxation and recovery: y is largest at the step
  rises,            // creep with an instantaneous part
  rises_from_zero,  // creep without one: y is 0 at the step
};

// The step of y(x), with the shape that y has after it. Where y is largest (falls), or where it
// leaves its first level (rises), rows before that moment lie before the step. The clock's zero is
// the step where it lies within one row's distance of it, and where the times are spaced by a
// constant factor; otherwise the step is at that row. `ramp` is the duration of a loading ramp that
// ends there: the origin is its start. Throws InputError for a creep from zero whose first row is
// not near zero, since it began before the record.                docs/theory.md [time_origin]
[[nodiscard]] StepOrigin step_origin(std::span<const double> x, std::span<const double> y,
                                     AfterStep shape, double ramp);

// The standard deviation of white noise in y, from its second differences (median, so that steps
// do not count); 0 for fewer than 5 values.
[[nodiscard]] double noise_of(std::span<const double> y);

}  // namespace palpate::fit
