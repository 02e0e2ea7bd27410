// Fills a row; indentation, radius and pressure are those of the deepest contact.
#include "run/contact_row.h"

#include <limits>

#include "contact/friction.h"

namespace palpate::run {

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

}  // namespace palpate::run
