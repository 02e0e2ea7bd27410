// What the finger does to the surface at one moment, as a picture of numbers.
#pragma once

#include "record/pressure_map.h"
#include "run/contacts.h"

namespace palpate::run {

// Pressure, traction and gap over the contacts' surroundings, seen from above. `scene` gives the
// moduli and radii. The integral of the pressure is Touch::normal_force().
[[nodiscard]] record::PressureMap draw_map(const scene::Scene& scene, const Touch& touch);

}  // namespace palpate::run
