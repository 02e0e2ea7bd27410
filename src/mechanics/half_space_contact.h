// The contact of the models `hertz` and `layer`: every sphere on a half-space or layer, no mesh.
#pragma once

#include <optional>
#include <string>

#include "mechanics/contacts.h"

namespace palpate::mechanics {

// Computes the contacts of `touch` for its travel below `top` (m), the lowest point of the finger
// when it first touches. The depth of all spheres is the travel, or follows from it where the
// surface is inclined. Returns a sentence if the contact law does not apply.
[[nodiscard]] std::optional<std::string> press_half_space(const scene::Scene& scene,
                                                          const Vec3& top, Touch& touch);

}  // namespace palpate::mechanics
