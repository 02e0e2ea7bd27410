// Whole numbers of rows and steps.
#include "run/pace.h"

#include <algorithm>
#include <cmath>

namespace palpate::run {

Pace make_pace(const scene::Scene& scene, double duration) {
  const double interval = scene.scenario.output.interval;
  Pace pace;
  // A duration that is a whole number of intervals but for rounding keeps that number.
  pace.rows = std::max(1, static_cast<int>(std::ceil(duration / interval - 1e-6)));
  pace.spacing = duration / pace.rows;
  if (scene.specimen) {
    const scene::TimePlan& plan = scene.specimen->plan;
    pace.steps = static_cast<int>(std::lround(interval / plan.time_step)) * plan.substeps;
  }
  pace.step = pace.spacing / pace.steps;
  return pace;
}

bool end_early(record::CaseRecord& record, record::Outcome outcome, const std::string& reason) {
  record.outcome = outcome;
  record.reason = reason;
  return false;
}

}  // namespace palpate::run
