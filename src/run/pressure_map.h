// Pressure maps of a touch.
#pragma once

#include "mechanics/contacts.h"
#include "record/record.h"
#include "solid/finger_press.h"

namespace palpate::run {

// Pressure, traction and gap around the contacts, seen from above, without time, step and case. The
// integral of the pressure is Touch::normal_force().        docs/theory.md, below [half_space]
[[nodiscard]] record::PressureMap draw_map(const scene::Scene& scene,
                                           const mechanics::Touch& touch);

// The same of a solid, whose tractions at nodes are linear between them where the surface touches,
// and integrate to `force` (N); `reach` (m) is the radius of the contact.
[[nodiscard]] record::PressureMap draw_map(const solid::FingerPress::OuterSurface& outer_surface,
                                           double reach, double force, const Vec3& finger);

}  // namespace palpate::run
