// Computes the numbers of rows and solver steps, and fills rows.
#include "run/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/friction.h"
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

record::ContactRow contact_row(const scene::Scene& scene, const mechanics::Touch& touch) {
  const scenario::PlainContact& contact = scene.scenario.contact;
  record::ContactRow row;
  row.travel = touch.travel;
  row.slide = touch.slide;
  row.contact_force = touch.normal_force();
  row.ambient = contact.ambient_force;
  row.force = touch.force() + contact.ambient_force;
  row.friction =
      touch.contacts.empty()
          ? 0.0
          : contact::friction::limit(contact.friction, touch.pressed(), scene.finger.weight);
  row.tangential = touch.drag().norm();
  row.tissue_radius = std::numeric_limits<double>::infinity();
  if (const mechanics::SphereContact* deepest = touch.deepest()) {
    row.indentation = deepest->depth;
    row.contact_radius = deepest->patch.radius();
    row.peak_pressure = mechanics::peak_pressure(*deepest);
    row.mesh_error = mechanics::mesh_error(*deepest);
    if (deepest->law.mean_curvature != 0.0) row.tissue_radius = 1.0 / deepest->law.mean_curvature;
  }
  row.contacts = static_cast<int>(touch.contacts.size());
  return row;
}

bool end_early(record::CaseRecord& record, record::Outcome outcome, const std::string& reason) {
  record.outcome = outcome;
  record.reason = reason;
  record.unstable = mechanics::tells_instability(reason);
  return false;
}

}  // namespace palpate::run
