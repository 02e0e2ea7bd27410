// The solution of Cattaneo and Mindlin, whose inverse is contact::friction::drag().
#pragma once

#include <cmath>

namespace palpate::test {

// Under a tangential force Q below the limit, N. `shear_compliance` is
// q = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, 1/Pa.
//                                  K. L. Johnson 1985, sec. 7.2; docs/theory.md [cattaneo]
struct Stick {
  double radius = 0.0;        // m, of the sticking core
  double displacement = 0.0;  // m, tangential, of the finger relative to the tissue
  double stiffness = 0.0;     // N/m, 8 a / q, dQ/dx at Q = 0
};

inline Stick stick(double tangential_force, double limit, double contact_radius,
                   double shear_compliance) {
  // c/a = (1 - Q/(mu P))^(1/3), dx = (3 mu P / 16 a) q [1 - (1 - Q/(mu P))^(2/3)]
  const double core = std::cbrt(1.0 - tangential_force / limit);
  return {.radius = contact_radius * core,
          .displacement =
              3.0 * limit / (16.0 * contact_radius) * shear_compliance * (1.0 - core * core),
          .stiffness = 8.0 * contact_radius / shear_compliance};
}

}  // namespace palpate::test
