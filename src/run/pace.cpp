// Computes the numbers of rows and solver steps.
#include "run/pace.h"

#include <algorithm>
#include <cmath>

#include "mechanics/monitor.h"

namespace palpate::run {

namespace {

int steps_a_row(const scene::Scene& scene) {
  if (!scene.specimen) return 1;
  const scene::TimePlan& plan = scene.specimen->plan;
  const double interval = scene.scenario.output.interval;
  return static_cast<int>(std::lround(interval / plan.time_step)) * plan.substeps;
}

}  // namespace

Pace make_pace(const scene::Scene& scene, double duration) {
  // Rounding errors in a duration of a whole number of intervals add no row.
  const double rows = std::ceil(duration / scene.scenario.output.interval - 1e-6);
  int steps = steps_a_row(scene);
  // One short row does not need the steps of a whole interval.
  if (rows <= 1.0)
    steps = std::max(
        1, static_cast<int>(std::ceil(steps * duration / scene.scenario.output.interval - 1e-6)));
  return {duration, std::max(1, static_cast<int>(rows)), steps};
}

Pace make_open_pace(const scene::Scene& scene, double longest) {
  const double interval = scene.scenario.output.interval;
  const int rows = static_cast<int>(std::ceil(longest / interval));
  return {interval * rows, rows, steps_a_row(scene)};
}

bool end_early(record::CaseRecord& record, record::Outcome outcome, const std::string& reason) {
  record.outcome = outcome;
  record.reason = reason;
  record.unstable = mechanics::tells_instability(reason);
  return false;
}

}  // namespace palpate::run
