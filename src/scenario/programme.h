// The duration of a loading programme, and the places to which it moves the finger.
#pragma once

#include <array>
#include <vector>

#include "scenario/resolved.h"

namespace palpate::scenario {

// The duration of all steps, s; a step to a force counts as zero.
[[nodiscard]] double programme_time(const PlainScenario& scenario);

// The positions of the finger above a cuboid at the start and after every slide: x and y, m, from
// the cuboid's corner.
[[nodiscard]] std::vector<std::array<double, 2>> finger_places(const Resolved& scenario,
                                                               const Cuboid& box);

}  // namespace palpate::scenario
