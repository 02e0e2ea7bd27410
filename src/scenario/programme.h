// The duration of a loading history, and the places to which it moves the finger.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved.h"

namespace palpate::scenario {

// The unit vector of `x`, `-y` or three numbers such as `0 0.2 1`; empty for other texts.
[[nodiscard]] std::optional<Vec3> direction_of(const std::string& text);

// The duration of all steps, s; a step to a force counts as zero.
[[nodiscard]] double programme_time(const PlainScenario& scenario);

// The positions of the finger above a cuboid at the start and after every slide: x and y, m, from
// the cuboid's corner.
[[nodiscard]] std::vector<std::array<double, 2>> finger_places(const Resolved& scenario,
                                                               const Cuboid& box);

// Why the closed formula of a compression, which needs one viscous law for the whole body, does not
// apply in this scenario; nothing where it does.
[[nodiscard]] std::optional<std::string> compression_problem(const Scenario& scenario,
                                                             const Compress& compress);

// Whether the loading history begins with a `compress`, which has no inertia.
[[nodiscard]] bool compresses(const PlainScenario& scenario);

// How the upper platen of a uniform test holds the specimen.
[[nodiscard]] tissue::Base upper_platen(const PlainScenario& scenario);

}  // namespace palpate::scenario
