// The position at which the finger first meets the specimen; travel is zero there.
#pragma once

#include "geometry/smooth_surface.h"
#include "scene/scene.h"

namespace palpate::scene {

struct FirstTouch {
  Vec3 finger = Vec3::Zero();  // m, the finger's reference point at that moment
  int sphere = 0;              // the sphere that touches
  geometry::SurfacePoint at;   // the point of the surface where it touches
};

// Lowers the finger vertically at its x and y onto the undeformed specimen. Throws MeshError if the
// finger passes beside the specimen.
[[nodiscard]] FirstTouch first_touch(const Scene& scene);

// The place (m) of the press: the scenario's x and y, or the specimen's middle, at its top.
[[nodiscard]] Vec3 pressed_place(const Scene& scene);

}  // namespace palpate::scene
