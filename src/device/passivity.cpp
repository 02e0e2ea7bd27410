// Time-domain passivity: observer and controller, docs/theory.md [arm].
#include "device/passivity.h"

#include <algorithm>

namespace palpate::device {

void PassivityObserver::step(const Vec3& position, const Vec3& force) {
  if (any_) energy_ -= force.dot(position - last_);
  least_ = std::min(least_, energy_);
  last_ = position;
  any_ = true;
}

Vec3 PassivityController::step(const PassivityObserver& observer, const Vec3& velocity, double dt) {
  damping_ = 0.0;
  const double power = velocity.squaredNorm() * dt;  // J, dissipated by a damping of 1 N s/m
  if (observer.energy() >= 0.0 || !(power > 0.0)) return Vec3::Zero();
  // The observer receives the damped force in the next step, so nothing is added to it here.
  damping_ = std::min(most_, -observer.energy() / power);
  return -damping_ * velocity;
}

}  // namespace palpate::device
