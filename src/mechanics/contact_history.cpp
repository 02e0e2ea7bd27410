// Viscoelastic force of all contacts together, step by step.
#include "mechanics/contact_history.h"

#include <algorithm>
#include <cmath>

namespace palpate::mechanics {

ContactHistory::ContactHistory(const scene::Scene& scene) {
  if (scene.relaxation.elastic()) return;
  contact_.emplace(scene.relaxation);
  shortest_time_ = scene.relaxation.retardation_time;
  for (const contact::Branch& branch : scene.relaxation.branches)
    shortest_time_ = shortest_time_ > 0.0 ? std::min(shortest_time_, branch.time) : branch.time;
}

// Advances to `depth` with its elastic force, in parts that are short compared with the relaxation
// times. In between, the elastic force is a power of the depth, h^(3/2) from the first touch on.
// Returns the viscoelastic force, N. pow() is called once per part, outside the mesh's solver step.
double ContactHistory::press(double time_step, double depth, double elastic) {
  constexpr double parts_a_time = 50.0;
  constexpr double most_parts = 256.0;
  const double wanted = std::ceil(parts_a_time * time_step / shortest_time_);
  const int parts = static_cast<int>(std::clamp(wanted, depth == depth_ ? 1.0 : 4.0, most_parts));
  const bool both = depth > 0.0 && depth_ > 0.0 && depth != depth_;
  const double power = both ? std::log(elastic / elastic_) / std::log(depth / depth_) : 1.5;
  const double known = depth > depth_ ? depth : depth_;
  const double known_force = depth > depth_ ? elastic : elastic_;
  double force = 0.0;
  for (int i = 1; i <= parts; ++i) {
    const bool last = i == parts;
    const double here = last ? depth : depth_ + (depth - depth_) * i / parts;
    double there = 0.0;
    if (here > 0.0) there = last ? elastic : known_force * std::pow(here / known, power);
    force = contact_->step(time_step / parts, here, there);
  }
  depth_ = depth;
  elastic_ = elastic;
  return force;
}

void ContactHistory::pass(const scene::Scene& scene, double time_step, Touch& touch) {
  if (!contact_) return;
  double elastic = 0.0;
  double depth = std::min(0.0, touch.travel);
  for (const SphereContact& contact : touch.contacts) {
    elastic += contact.force;
    depth = std::max(depth, contact.approach);
  }
  double force = slides_ ? press(time_step, depth_, elastic_) : press(time_step, depth, elastic);
  if (slides_) force *= elastic_ > 0.0 ? elastic / elastic_ : 0.0;
  if (force <= 0.0) {
    touch.contacts.clear();
    return;
  }
  const double edge = depth_ > 0.0 ? contact_->contact_depth() / depth_ : 1.0;
  for (SphereContact& contact : touch.contacts) {
    contact.force *= force / elastic;
    const auto [a, b] = contact.law.semi_axes(edge * contact.depth);
    contact.patch.a = a;
    contact.patch.b = b;
  }
  rub(scene, Vec3::Zero(), touch);  // friction with the new normal forces
}

}  // namespace palpate::mechanics
