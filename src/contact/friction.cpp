// Coulomb's limit, and the solution of Cattaneo and Mindlin.
#include "contact/friction.h"

#include <algorithm>
#include <cmath>

namespace palpate::contact::friction {

double limit(double coefficient, double contact_force, double weight) {
  return coefficient * (contact_force + weight);
}

Stick stick(double tangential_force, double limit, double contact_radius, double shear_compliance) {
  // c/a = (1 - Q/(mu P))^(1/3), dx = (3 mu P / 16 a) q [1 - (1 - Q/(mu P))^(2/3)]
  const double core = std::cbrt(1.0 - tangential_force / limit);
  return {.radius = contact_radius * core,
          .displacement =
              3.0 * limit / (16.0 * contact_radius) * shear_compliance * (1.0 - core * core),
          .stiffness = 8.0 * contact_radius / shear_compliance};
}

Vec3 drag(Vec3& stretch, double limit, double contact_radius, double shear_compliance) {
  if (!(limit > 0.0)) {
    stretch.setZero();
    return Vec3::Zero();
  }
  // x_slip = 3 mu F q / (16 a),  T = mu F [1 - (1 - x / x_slip)^(3/2)]
  const double most = 3.0 * limit * shear_compliance / (16.0 * contact_radius);
  const double length = stretch.norm();
  if (length <= 0.0) return Vec3::Zero();
  const Vec3 direction = stretch / length;
  if (length > most) stretch = most * direction;
  const double left = std::max(0.0, 1.0 - length / most);
  return limit * (1.0 - left * std::sqrt(left)) * direction;
}

}  // namespace palpate::contact::friction
