// Where the finger first meets the specimen on its way down: there its travel is 0.
#pragma once

#include "geometry/smooth_surface.h"
#include "scene/scene.h"

namespace palpate::scene {

struct FirstTouch {
  Vec3 finger = Vec3::Zero();  // m, the finger's point at that moment
  int sphere = 0;              // that touches
  geometry::SurfacePoint at;   // where it does
};

// The finger comes straight down over its x and y onto the specimen at rest.
// Throws MeshError where it passes beside the specimen.
[[nodiscard]] FirstTouch first_touch(const Scene& scene);

// Above the middle of the specimen, or of its shape, or where the scenario says; at its top, m.
[[nodiscard]] Vec3 pressed_place(const Scene& scene);

}  // namespace palpate::scene
