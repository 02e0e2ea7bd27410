// What a mesh costs in the force, before a run.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace palpate::run {

// The mesh's own error in the static force at the deepest travel of the programme, a fraction of
// it. Nothing without a finger on a mesh with `consistent`, or where the contact has no solution.
//                                                                        docs/theory.md (12)
[[nodiscard]] std::optional<double> mesh_error(const scene::Scene& scene);

}  // namespace palpate::run
