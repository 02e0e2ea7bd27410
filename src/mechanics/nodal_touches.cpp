// Sums nodal forces to one contact per sphere.
#include "mechanics/nodal_touches.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate::mechanics {

NodalTouches::NodalTouches(const scene::Scene& scene)
    : scene_(&scene),
      surface_(&*scene.specimen->surface),
      tree_(surface_->surface()),
      stars_(surface_->surface(), surface_->neighbours(), {}) {}

// Hertz's law at the pressed place, for estimates; the nodal forces do not use it.
contact::ContactLaw NodalTouches::law_for_estimates(const geometry::SurfacePoint& at) const {
  const contact::SphereLaw sphere{scene_->finger.sphere_radius, scene_->finger.sphere_modulus};
  const auto corners = stars_.at_corners(surface_->surface(), at.triangle);
  const auto found = geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (found.known())
    if (const auto law =
            contact::contact_law(scene_->scenario.contact.law, sphere, found.curvature))
      return *law;
  return *contact::contact_law(scene_->scenario.contact.law, sphere, {});
}

// Adds the contact of one sphere, from the forces on its nodes; nothing if all are zero.
void NodalTouches::fill(int sphere, const Ball& ball, const std::vector<PushedNode>& nodes,
                        const Touch& before, Touch& touch) const {
  SphereContact& contact = touch.contacts.add();
  contact.sphere = sphere;
  Vec3 sum = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  double total = 0.0;
  double area = 0.0;
  for (const PushedNode& one : nodes) {
    if (one.skin.sphere != sphere) continue;
    contact.nodal.vertices.push_back(one.skin.vertex);
    contact.nodal.gap.push_back(std::max(0.0, one.left));
    if (one.force <= 0.0) continue;
    contact.load.vertices.push_back(one.skin.vertex);
    contact.load.shares.push_back(one.force);
    contact.nodal.push.push_back(one.force * one.push);
    sum += one.force * one.push;
    centre += one.force * one.skin.place;
    contact.nodal.peak_pressure = std::max(contact.nodal.peak_pressure, one.force / one.skin.area);
    total += one.force;
    area += one.skin.area;
  }
  if (total <= 0.0) {
    touch.contacts.erase(touch.contacts.size() - 1);
    return;
  }
  contact.force = sum.norm();
  for (double& share : contact.load.shares) share /= total;
  for (Vec3& push : contact.nodal.push) push /= contact.force;
  const auto foot = surface_->foot(ball.centre, tree_.nearest(ball.centre));
  contact.patch.at = foot.at;
  contact.patch.position = centre / total;
  contact.patch.normal = -sum / contact.force;
  contact.patch.axis = contact.patch.normal.unitOrthogonal();
  contact.patch.a = contact.patch.b = std::sqrt(area / std::numbers::pi);
  contact.approach = contact.depth = ball.radius - foot.height;
  contact.law = law_for_estimates(foot.at);
  for (const SphereContact& old : before.contacts)
    if (old.sphere == sphere) contact.stretch = old.stretch;
}

void NodalTouches::meet(const Vec3& finger, const std::vector<Ball>& balls,
                        const std::vector<PushedNode>& nodes, Touch& touch) const {
  Touch next = touch;
  next.finger = finger;
  next.contacts.clear();
  for (std::size_t i = 0; i < balls.size(); ++i)
    fill(static_cast<int>(i), balls[i], nodes, touch, next);
  rub(*scene_, finger - touch.finger, next);
  touch = std::move(next);
}

}  // namespace palpate::mechanics
