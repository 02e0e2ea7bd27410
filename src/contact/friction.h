// Friction of the finger: Coulomb's limit (eq. 4), and stick before slip.
#pragma once

#include "base/vec3.h"

namespace palpate::contact::friction {

// F_m = mu (F_c + W), N: what the contact can carry before it slides, and carries while it does.
// The integral of mu P over the contact is exactly mu F_c. `weight` is the finger's own weight
// where it does not already rest in F_c, else 0.            Chen 2007 eq. (4); docs/theory.md (7)
[[nodiscard]] double limit(double coefficient, double contact_force, double weight);

// Cattaneo-Mindlin stick before slip under a tangential force Q below the limit.
// `shear_compliance` is q = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, 1/Pa.
//                                       K. L. Johnson 1985, sec. 7.2; docs/theory.md (54)
struct Stick {
  double radius = 0.0;        // m, of the sticking core
  double displacement = 0.0;  // m, tangential, of the finger against the tissue
  double stiffness = 0.0;     // N/m, 8 a / q, at the first touch of Q
};
[[nodiscard]] Stick stick(double tangential_force, double limit, double contact_radius,
                          double shear_compliance);

// The other way round, N: the tangential force on the tissue where the finger has moved by
// `stretch` (m, tangential) against it; at most the limit, where all of the contact slips. A longer
// stretch is cut to what slip leaves of it. Zero without a limit. docs/theory.md (8)
[[nodiscard]] Vec3 drag(Vec3& stretch, double limit, double contact_radius,
                        double shear_compliance);

}  // namespace palpate::contact::friction
