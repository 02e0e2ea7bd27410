// The closed forms of Hertz contact.
#include "contact/hertz.h"

#include <cmath>
#include <numbers>

namespace palpate::contact {

double Elastic::compliance() const { return (1.0 - poisson_ratio * poisson_ratio) / young_modulus; }

namespace hertz {

double effective_modulus(double compliance_1, double compliance_2) {
  return 1.0 / (compliance_1 + compliance_2);
}

double effective_radius(double sphere_radius, double curvature) {
  return 1.0 / (1.0 / sphere_radius + curvature);
}

double force(double depth, double radius, double modulus) {
  if (depth <= 0.0) return 0.0;
  // F = 4/3 E* sqrt(R) h^(3/2)                   Chen 2007 eq. (2); docs/theory.md [hertz]
  return 4.0 / 3.0 * modulus * std::sqrt(radius) * depth * std::sqrt(depth);
}

double depth(double force, double radius, double modulus) {
  if (force <= 0.0) return 0.0;
  // h = (3 F / (4 E* sqrt(R)))^(2/3); not used in solver steps, so cbrt is allowed
  const double root = std::cbrt(0.75 * force / (modulus * std::sqrt(radius)));
  return root * root;
}

double stiffness(double depth, double radius, double modulus) {
  if (depth <= 0.0) return 0.0;
  return 2.0 * modulus * std::sqrt(radius * depth);
}

double contact_radius(double depth, double radius) {
  return depth > 0.0 ? std::sqrt(radius * depth) : 0.0;
}

double peak_pressure(double force, double contact_radius) {
  if (contact_radius <= 0.0) return 0.0;
  // P_0 = 3 F / (2 pi a^2)                    Chen 2007 eq. (3); docs/theory.md [pressure]
  return 1.5 * force / (std::numbers::pi * contact_radius * contact_radius);
}

}  // namespace hertz
}  // namespace palpate::contact
