// Collects the parts of a scene that its picture shows.
#pragma once

#include "record/scene_picture.h"
#include "scene/scene.h"

namespace palpate::run {

// The specimen's skin, the surfaces of the regions inside it (counter-clockwise from outside the
// region), and the finger at its first touch. The scene must have a specimen and a finger.
[[nodiscard]] record::ScenePicture make_picture(const scene::Scene& scene);

}  // namespace palpate::run
