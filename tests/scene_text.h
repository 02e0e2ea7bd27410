// Scenes of scenarios that are texts.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.h"
#include "scene/scene.h"

namespace palpate::test {

using Settings = std::vector<std::string>;  // `key=value`

inline scene::Scene first_scene(const scenario::Family& family) {
  return scene::build(family.cases.front(), family);
}

inline scene::Scene scene_of(const std::string& text, const Settings& settings = {}) {
  return first_scene(scenario::parse(text, "test.toml", settings));
}

}  // namespace palpate::test
