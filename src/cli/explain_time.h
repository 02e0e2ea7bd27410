// The lines of `palpate explain` on time: integrator, stability limit, steps.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace palpate::cli {

// The scene must have a specimen.
[[nodiscard]] std::vector<std::string> explain_time(const scene::Scene& scene);

}  // namespace palpate::cli
