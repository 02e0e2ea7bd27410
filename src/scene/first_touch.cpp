// Finds the first touch by bisection between a height without contact and one with contact.
#include "scene/first_touch.h"

#include <algorithm>
#include <vector>

#include "base/numerics.h"
#include "base/units.h"
#include "contact/detection.h"
#include "geometry/box.h"
#include "scene/places.h"

namespace palpate::scene {

Vec3 pressed_place(const Scene& scene) {
  if (!scene.specimen) return scene.choice.touch.lowest;
  const scenario::PlainFinger& finger = scene.scenario.finger;
  const Vec3 middle = 0.5 * (scene.specimen->low + scene.specimen->high);
  return {finger.x.value_or(middle.x()), finger.y.value_or(middle.y()), scene.specimen->high.z()};
}

KeyError beside(const Vec3& place, const Vec3& low, const Vec3& high) {
  const Vec3 off = (place - 0.5 * (low + high)).cwiseAbs().cwiseQuotient(high - low);
  return {off.x() >= off.y() ? "finger.x" : "finger.y",
          "the finger passes beside the specimen at x " + quantity_text(place.x(), unit::mm) +
              ", y " + quantity_text(place.y(), unit::mm) + ", where it has nothing: its box has " +
              box_text({low, high}) + "; set `finger.x` and `finger.y` to a place above it"};
}

FirstTouch lowered_onto(const geometry::SmoothSurface& surface, const Vec3& place,
                        const Spheres& spheres) {
  const std::span<const Vec3> centres = spheres.centres;
  const double radius = spheres.radius;
  contact::Detector detector(surface);
  std::vector<geometry::SmoothSurface::ClosestPoint> feet;
  const geometry::Box box = geometry::box_of(surface.surface().vertices);
  FirstTouch touch;
  touch.finger = place;
  // Whether a sphere touches if the finger's point is at height z; stores the deepest touch.
  const auto touches = [&](double z) {
    double deepest = 0.0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      Vec3 centre = touch.finger + centres[i];
      centre.z() = z + centres[i].z();
      detector.find(centre, radius, {}, feet);
      for (const auto& closest_point : feet) {
        // On a ridge of facets the normal at the nearest place may not be the way to it.
        constexpr double aslant = 1.001;
        const double away = (centre - closest_point.position).norm();
        const double height = closest_point.height > 0.0 && away > aslant * closest_point.height
                                  ? away
                                  : closest_point.height;
        if (radius - height <= deepest) continue;
        deepest = radius - height;
        touch.sphere = static_cast<int>(i);
        touch.at = closest_point.at;
        touch.on_crease = closest_point.on_crease;
      }
    }
    return deepest > 0.0;
  };
  double clear = place.z() + 2.0 * radius;
  double touching = clear;
  while (!touches(touching)) {
    if (touching < std::min(place.z(), box.low.z())) throw beside(place, box.low, box.high);
    clear = touching;
    touching -= 0.25 * radius;
  }
  // To the last bit: two neighbouring numbers.
  const numerics::Interval reach = numerics::change({touching, clear}, 0.0, touches);
  [[maybe_unused]] const bool reached = touches(reach.low);  // stores the touch at this height
  touch.finger.z() = reach.high;                             // without contact force at zero travel
  return touch;
}

FirstTouch first_touch(const Scene& scene) {
  return lowered_onto(*scene.specimen->surface, pressed_place(scene),
                      {scene.finger.centres, scene.finger.sphere_radius});
}

contact::Patch first_patch(const Scene& scene, double radius) {
  const geometry::SmoothSurface& surface = *scene.specimen->surface;
  contact::Patch patch{.at = first_touch(scene).at, .a = radius, .b = radius, .beyond = {}};
  patch.position = surface.position(patch.at);
  patch.normal = surface.normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  return patch;
}

}  // namespace palpate::scene
