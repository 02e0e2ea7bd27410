// Friction of the finger: Coulomb's limit (Chen 2007 eq. (4)), and stick before slip.
#pragma once

#include <Eigen/Core>

#include "base/vec3.h"

namespace palpate::contact::friction {

// F_m = mu (F_c + W), N: the largest tangential force before sliding, and the force during sliding.
// The integral of mu P over the contact is exactly mu F_c. `weight` is the finger's weight if it is
// not part of F_c, otherwise 0.                  Chen 2007 eq. (4); docs/theory.md [friction]
[[nodiscard]] double limit(double coefficient, double contact_force, double weight);

// Stick before slip after Cattaneo and Mindlin (K. L. Johnson 1985, sec. 7.2; docs/theory.md
// [cattaneo]), N: the tangential force on the tissue after the finger has moved by `stretch` (m,
// tangential) relative to it. `shear_compliance` is q = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, 1/Pa.
// `beyond` (m/N, symmetric, tangential) times this force is what the body moves beyond a
// half-space. Its largest value is the limit, at which the whole contact slips; a longer stretch is
// shortened along the force to that of the limit. Zero, with the stretch reset, if limit <= 0.
//                                                                         docs/theory.md [stick]
[[nodiscard]] Vec3 drag(Vec3& stretch, double limit, double contact_radius, double shear_compliance,
                        const Eigen::Matrix3d& beyond = Eigen::Matrix3d::Zero());

}  // namespace palpate::contact::friction
