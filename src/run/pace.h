// How a step of the programme is cut into rows and solver steps, and how a case ends early.
#pragma once

#include <string>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Rows at equal times, not longer than the output interval; each of `steps` solver steps.
struct Pace {
  int rows = 1;
  double spacing = 0.0;  // s, between rows
  int steps = 1;         // of the solver, a row; 1 without a mesh
  double step = 0.0;     // s
};

// For a step that takes `duration` seconds.
[[nodiscard]] Pace make_pace(const scene::Scene& scene, double duration);

// Marks the case as ended early, with a sentence; returns false for the caller to return.
[[nodiscard]] bool end_early(record::CaseRecord& record, record::Outcome outcome,
                             const std::string& reason);

}  // namespace palpate::run
