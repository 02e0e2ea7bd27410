// Pressure maps of a touch.
#pragma once

#include "mechanics/contacts.h"
#include "record/pressure_map.h"

namespace palpate::run {

// Pressure, traction and gap around the contacts, seen from above, without time, step and case. The
// integral of the pressure is Touch::normal_force().               docs/theory.md, below (5)
[[nodiscard]] record::PressureMap draw_map(const scene::Scene& scene,
                                           const mechanics::Touch& touch);

}  // namespace palpate::run
