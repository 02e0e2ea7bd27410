// The position at which the finger first meets the specimen; travel is zero there.
#pragma once

#include <span>

#include "base/error.h"
#include "contact/patch.h"
#include "geometry/smooth_surface.h"
#include "scene/scene.h"

namespace palpate::scene {

struct FirstTouch {
  Vec3 finger = Vec3::Zero();  // m, the finger's reference point at that moment
  int sphere = 0;              // the sphere that touches
  geometry::SurfacePoint at;   // the point of the surface where it touches
  bool on_crease = false;
};

// Spheres around a reference point.
struct Spheres {
  std::span<const Vec3> centres;  // m, from the reference point
  double radius = 0.0;            // m, of each
};

// That the finger passes beside the specimen, whose box (m) is given, at the x and y of a place
// (m): an error at the key of the coordinate that is farther off.
[[nodiscard]] KeyError beside(const Vec3& place, const Vec3& low, const Vec3& high);

// Lowers spheres vertically onto a surface, with their reference point above the place (m), whose
// height is at least that of the surface's top. Throws KeyError if they pass beside the surface.
[[nodiscard]] FirstTouch lowered_onto(const geometry::SmoothSurface& surface, const Vec3& place,
                                      const Spheres& spheres);

// Lowers the finger vertically at its x and y onto the undeformed specimen. Throws KeyError if the
// finger passes beside the specimen.
[[nodiscard]] FirstTouch first_touch(const Scene& scene);

// The circular contact of a radius (m) there.
[[nodiscard]] contact::Patch first_patch(const Scene& scene, double radius);

// The place (m) of the press: the scenario's x and y, or the specimen's middle, at its top. Without
// a mesh, the lowest point of the finger when it first touches.
[[nodiscard]] Vec3 pressed_place(const Scene& scene);

}  // namespace palpate::scene
