// Scenes of scenarios that are texts.
#pragma once

#include <string>
#include <vector>

#include "run/choose.h"
#include "scenario/family.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"

namespace palpate::test {

using Settings = std::vector<std::string>;  // `key=value`

inline scene::Scene first_scene(const scenario::Family& family) {
  scene::SpecimenShapes shapes;
  const scenario::Case& one = family.cases.front();
  return scene::build(one, family, shapes, run::choose(one, shapes));
}

inline scene::Scene scene_of(const std::string& text, const Settings& settings = {}) {
  return first_scene(scenario::parse(text, "test.toml", settings));
}

}  // namespace palpate::test
