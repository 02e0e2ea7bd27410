// `palpate explain --json`.
#pragma once

#include <string>

#include "run/answer.h"
#include "scene/scene.h"

namespace palpate::cli {

// One JSON object without line feeds: the plain sentences, the criteria, the models with their
// errors, and what is left out. Errors and changes are fractions; infinite numbers are null.
[[nodiscard]] std::string explain_json(const std::string& scenario, const scene::Scene& scene,
                                       const run::Expected& expected);

}  // namespace palpate::cli
