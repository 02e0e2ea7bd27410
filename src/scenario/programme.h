// How long the programme of a press is, and where it leads.
#pragma once

#include <array>
#include <vector>

#include "scenario/scenario.h"

namespace palpate::scenario {

// All steps together, s; none of them ends at a force, nor is a uniform test.
[[nodiscard]] double programme_time(const Scenario& scenario);

// Where the finger stands over a cuboid at the start and after every slide: x and y, m, from its
// corner.
[[nodiscard]] std::vector<std::array<double, 2>> finger_places(const Scenario& scenario,
                                                               const Cuboid& box);

}  // namespace palpate::scenario
