// How a step of the programme is cut into rows and solver steps, and how a case ends early.
#pragma once

#include <string>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Rows at equal times, not longer than the output interval; each of `steps` solver steps.
struct Pace {
  double duration = 0.0;  // s
  int rows = 1;
  int steps = 1;  // of the solver, a row; 1 without a mesh

  [[nodiscard]] double step() const { return duration / (static_cast<double>(rows) * steps); }

  // `steps_done` solver steps after `rows_done` rows, s: one division, so that whole intervals keep
  // their digits.
  [[nodiscard]] double time(int rows_done, int steps_done) const {
    const double all = static_cast<double>(rows) * steps;
    return duration * (static_cast<double>(rows_done) * steps + steps_done) / all;
  }
};

// For a step that takes `duration` seconds.
[[nodiscard]] Pace make_pace(const scene::Scene& scene, double duration);

// For a step of at most `longest` seconds that ends by itself: rows at the very interval.
[[nodiscard]] Pace make_open_pace(const scene::Scene& scene, double longest);

// Marks the case as ended early, with a sentence; returns false for the caller to return.
[[nodiscard]] bool end_early(record::CaseRecord& record, record::Outcome outcome,
                             const std::string& reason);

}  // namespace palpate::run
