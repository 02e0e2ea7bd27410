// Sums over the contacts of a moment, and their stick and slip.
#include <algorithm>
#include <cmath>

#include "run/contacts.h"

namespace palpate::run {

const SphereContact* Touch::deepest() const {
  const auto found =
      std::max_element(contacts.begin(), contacts.end(),
                       [](const auto& a, const auto& b) { return a.depth < b.depth; });
  return found == contacts.end() ? nullptr : &*found;
}

double Touch::normal_force() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force * contact.patch.normal.z();
  return sum;
}

double Touch::force() const { return normal_force() - drag().z(); }

Vec3 Touch::drag() const {
  Vec3 sum = Vec3::Zero();
  for (const SphereContact& contact : contacts) sum += contact.drag;
  return sum;
}

double Touch::pressed() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force;
  return sum;
}

void rub(const scene::Scene& scene, const Vec3& move, Touch& touch) {
  const double friction = scene.scenario.contact.friction;
  for (SphereContact& contact : touch.contacts) {
    contact.drag.setZero();
    const double limit = friction * contact.force;
    if (!(limit > 0.0)) {
      contact.stretch.setZero();
      continue;
    }
    const Vec3& normal = contact.patch.normal;
    contact.stretch += move;
    contact.stretch -= contact.stretch.dot(normal) * normal;
    // The stretch at which the whole patch slips: 3 mu F q / (16 a).
    const double most =
        3.0 * limit * scene.finger.shear_compliance / (16.0 * contact.patch.radius());
    const double stretch = contact.stretch.norm();
    if (stretch <= 0.0) continue;
    const Vec3 direction = contact.stretch / stretch;
    if (stretch > most) contact.stretch = most * direction;
    // Q = mu F [1 - (1 - stretch / most)^(3/2)]
    const double left = std::max(0.0, 1.0 - stretch / most);
    contact.drag = limit * (1.0 - left * std::sqrt(left)) * direction;
  }
}

}  // namespace palpate::run
