// The finger on the `hertz` rung: every sphere on its own half-space, no mesh.
#pragma once

#include <optional>
#include <string>

#include "run/contacts.h"

namespace palpate::run {

// Sets the touch's contacts for its travel below `top` (m), which has come along sideways: on the
// flat all spheres at once, on a curved surface the one sphere. Returns what is wrong where Hertz
// ends.
[[nodiscard]] std::optional<std::string> press_half_space(const scene::Scene& scene,
                                                          const Vec3& top, Touch& touch);

}  // namespace palpate::run
