// The result of a run over time, and its deviation from another one.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::chart {

// One moment of one step of the loading history: a press's contact force (N), a creep's strain, or
// a relaxation's stress (Pa).
struct Moment {
  int step = 0;       // counted from 1
  double time = 0.0;  // s
  double value = 0.0;
  double error = 0.0;  // of a reference's value, in its unit
};
using History = std::vector<Moment>;

// The rows of a run as moments, by time.
[[nodiscard]] History history(const scenario::PlainScenario& scenario,
                              const record::CaseRecord& record);

// Removes the moments at which the steps of a uniform test begin, because a sudden load has two
// values there, before and after. A press keeps all moments.
[[nodiscard]] History without_starts(const scenario::PlainScenario& scenario, const History& all);

// The time at which a step (from 1) of a uniform test begins, s.
[[nodiscard]] double start_of(const scenario::PlainScenario& scenario, int step);

// Differences divided by the largest value of the reference in steps of the same kind.
struct Deviation {
  double greatest = 0.0;  // largest over the moments of the reference
  double at_end = 0.0;    // of the loading history
  double rms = 0.0;       // over the moments
};

// The deviation of `got` from `reference` at the moments of `reference`; `got` is interpolated
// linearly within a step (a step of a press begins with the last moment of the step before).
// Nothing if `got` does not cover all moments, or a step of the reference is 0 throughout.
[[nodiscard]] std::optional<Deviation> deviation(const scenario::PlainScenario& scenario,
                                                 const History& got, const History& reference);

// The stated errors of the reference, divided in the same way.
[[nodiscard]] Deviation own_error(const scenario::PlainScenario& scenario,
                                  const History& reference);

}  // namespace palpate::chart
