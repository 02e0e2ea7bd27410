// Directions as scenarios write them.
#pragma once

#include <optional>
#include <string>

#include "base/vec3.h"

namespace palpate::scenario {

// The unit vector of `x`, `-y` or three numbers such as `0 0.2 1`; empty for other texts.
[[nodiscard]] std::optional<Vec3> direction_of(const std::string& text);

}  // namespace palpate::scenario
