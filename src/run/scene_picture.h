// A scene as a picture needs it.
#pragma once

#include "record/scene_picture.h"
#include "scene/scene.h"

namespace palpate::run {

// The specimen's skin and the surfaces of the regions inside it, each seen from outside, and the
// finger at its first touch. Needs a scene with a specimen and a finger.
[[nodiscard]] record::ScenePicture make_picture(const scene::Scene& scene);

}  // namespace palpate::run
