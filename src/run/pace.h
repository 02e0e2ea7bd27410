// Rows of a step of the loading history and its solver steps; ends a case early.
#pragma once

#include <string>

#include "mechanics/contacts.h"
#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Rows of equal duration, at most the output interval, each divided into `steps` solver steps.
struct Pace {
  double duration = 0.0;  // s
  int rows = 1;
  int steps = 1;  // solver steps per row; 1 without a mesh

  [[nodiscard]] double step() const { return duration / (static_cast<double>(rows) * steps); }

  // The time after `rows_done` rows and `steps_done` more solver steps, s, rounded only once, so
  // that multiples of the interval are exact.
  [[nodiscard]] double time(int rows_done, int steps_done) const {
    const double all = static_cast<double>(rows) * steps;
    return duration * (static_cast<double>(rows_done) * steps + steps_done) / all;
  }
};

// The pace of a step of `duration` s.
[[nodiscard]] Pace make_pace(const scene::Scene& scene, double duration);

// The pace of a step whose end is not known, of at most `longest` s: rows of exactly one interval.
[[nodiscard]] Pace make_open_pace(const scene::Scene& scene, double longest);

// A touch as a row, without step and time: indentation, radius and pressure are those of the
// deepest contact. Allocates nothing.
[[nodiscard]] record::ContactRow contact_row(const scene::Scene& scene,
                                             const mechanics::Touch& touch);

// Marks the case as ended early, with a sentence; always returns false.
[[nodiscard]] bool end_early(record::CaseRecord& record, record::Outcome outcome,
                             const std::string& reason);

// Runs all steps and adds rows, maps, frames, warnings and findings of the mesh to `record`. Throws
// Stopped where its thread is stopped.
void press(const scene::Scene& scene, record::CaseRecord& record);

// Runs every `creep` or `relax` step as a separate test of an unloaded specimen; time continues
// from step to step. Throws Stopped where its thread is stopped.
void load_uniformly(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
