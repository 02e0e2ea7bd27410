// A Hertz pressure drawn as pixels about the origin.
#pragma once

#include "record/pressure_map.h"

namespace palpate::run {

// 128 x 128 pixels over 1.25 contact radii to each side, each the mean of 8 x 8 points; an empty
// contact gives one pixel of zero. `force` in N, `contact_radius` in m.
[[nodiscard]] record::PressureMap hertz_map(double force, double contact_radius);

}  // namespace palpate::run
