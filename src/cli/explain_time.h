// What `palpate explain` says about time: method, stability limit, steps.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace palpate::cli {

// Lines about the steps of a scene with a specimen.
[[nodiscard]] std::vector<std::string> explain_time(const scene::Scene& scene);

}  // namespace palpate::cli
