// Friction of the finger: Coulomb's limit (eq. 4), its direction, and stick before slip.
#pragma once

#include "base/vec3.h"

namespace palpate::contact::friction {

// F_m = mu (F_c + W), N: what the contact can carry before it slides, and carries while it does.
// The integral of mu P over the contact is exactly mu F_c. `weight` is the finger's own weight
// where it does not already rest in F_c, else 0.                Chen 2007 eq. (4); theory.md (7)
[[nodiscard]] double limit(double coefficient, double contact_force, double weight);

// The friction force on the finger, N: against the slip velocity (m/s, tangential), growing
// smoothly with it and reaching the limit where the speed is far above `regular_speed` (m/s):
// -limit v / sqrt(|v|^2 + v_0^2). Zero without slip.                            theory.md (8)
[[nodiscard]] Vec3 force(double limit, const Vec3& slip_velocity, double regular_speed);

// Cattaneo-Mindlin stick before slip under a tangential force Q below the limit.
// `shear_compliance` is q = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, 1/Pa.     K. L. Johnson 1985, sec. 7.2
struct Stick {
  double radius = 0.0;        // m, of the sticking core
  double displacement = 0.0;  // m, tangential, of the finger against the tissue
  double stiffness = 0.0;     // N/m, 8 a / q, at the first touch of Q
};
[[nodiscard]] Stick stick(double tangential_force, double limit, double contact_radius,
                          double shear_compliance);

}  // namespace palpate::contact::friction
