// What a picture of a scene at rest shows.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// The body with its regions, the part of its surface that is held, and the finger at its first
// touch or the load between plates, with the body's `up` upwards. A mesh of springs is shown as it
// is; for other models the body is shown as it is given, of a half-space a piece of some finger
// radii, and a layer colours the surface. More than 6000 faces are made fewer. Nothing is computed.
[[nodiscard]] record::ScenePicture picture_of(const scene::Scene& scene);

}  // namespace palpate::run
