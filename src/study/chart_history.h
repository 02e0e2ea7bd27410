// A run's answer over time, and how far it is from another one.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::study {

// One moment of one step of the programme: a press's contact force (N), a creep's strain, or a
// relaxation's stress (Pa).
struct Moment {
  int step = 0;       // counted from 1
  double time = 0.0;  // s
  double value = 0.0;
  double error = 0.0;  // of a reference's value, in its unit
};
using History = std::vector<Moment>;

// The rows of a run as such moments, by time.
[[nodiscard]] History history(const scenario::Scenario& scenario, const record::CaseRecord& record);

// Without the moments at which a uniform test's steps begin: a load that comes at once has two
// answers there, before and after. Presses keep all of theirs.
[[nodiscard]] History without_starts(const scenario::Scenario& scenario, const History& all);

// When a step of a uniform test, counted from 1, begins, s.
[[nodiscard]] double start_of(const scenario::Scenario& scenario, int step);

// Differences over the greatest value of the reference in steps of the same kind.
struct Deviation {
  double greatest = 0.0;  // over the moments of the reference
  double at_end = 0.0;    // of the programme
  double rms = 0.0;       // over the moments
};

// `got` at the moments of `reference`, between its own ones by a straight line within a step. A
// step of a press begins where the one before it ended. Nothing where `got` does not reach all of
// them, or the reference has no value above 0.
[[nodiscard]] std::optional<Deviation> deviation(const scenario::Scenario& scenario,
                                                 const History& got, const History& reference);

// The reference's own error, likewise: `greatest` over moments, `at_end`, `rms`.
[[nodiscard]] Deviation own_error(const scenario::Scenario& scenario, const History& reference);

}  // namespace palpate::study
