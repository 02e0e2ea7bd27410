// Coulomb friction with a regularised slip speed, and the Cattaneo-Mindlin solution.
#include "contact/friction.h"

#include <cmath>

namespace palpate::contact::friction {

double limit(double coefficient, double contact_force, double weight) {
  return coefficient * (contact_force + weight);
}

Vec3 force(double limit, const Vec3& slip_velocity, double regular_speed) {
  const double speed = std::sqrt(slip_velocity.squaredNorm() + regular_speed * regular_speed);
  if (speed <= 0.0) return Vec3::Zero();
  return slip_velocity * (-limit / speed);
}

Stick stick(double tangential_force, double limit, double contact_radius, double shear_compliance) {
  // c/a = (1 - Q/(mu P))^(1/3), dx = (3 mu P / 16 a) q [1 - (1 - Q/(mu P))^(2/3)]
  const double core = std::cbrt(1.0 - tangential_force / limit);
  return {.radius = contact_radius * core,
          .displacement =
              3.0 * limit / (16.0 * contact_radius) * shear_compliance * (1.0 - core * core),
          .stiffness = 8.0 * contact_radius / shear_compliance};
}

}  // namespace palpate::contact::friction
