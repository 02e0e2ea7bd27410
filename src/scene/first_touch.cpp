// Finds the first touch by bisection between a height without contact and one with contact.
#include "scene/first_touch.h"

#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "contact/detection.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {

Vec3 pressed_place(const Scene& scene) {
  const scenario::PlainFinger& finger = scene.scenario.finger;
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  if (scene.specimen) {
    low = scene.specimen->low;
    high = scene.specimen->high;
  } else if (const auto shape = parametric(scene.scenario.tissue.shape)) {
    high = geometry::extent(*shape);
  }
  const Vec3 middle = 0.5 * (low + high);
  return {finger.x.value_or(middle.x()), finger.y.value_or(middle.y()), high.z()};
}

FirstTouch first_touch(const Scene& scene) {
  const Specimen& specimen = *scene.specimen;
  const Finger& finger = scene.finger;
  contact::Detector detector(*specimen.surface);
  std::vector<geometry::SmoothSurface::Foot> feet;
  FirstTouch touch;
  touch.finger = pressed_place(scene);
  const double radius = finger.sphere_radius;
  // Whether a sphere touches if the finger's point is at height z; stores the deepest touch.
  const auto touches = [&](double z) {
    double deepest = 0.0;
    for (std::size_t i = 0; i < finger.centres.size(); ++i) {
      Vec3 centre = touch.finger + finger.centres[i];
      centre.z() = z + finger.centres[i].z();
      detector.find(centre, radius, {}, feet);
      for (const auto& foot : feet) {
        if (radius - foot.height <= deepest) continue;
        deepest = radius - foot.height;
        touch.sphere = static_cast<int>(i);
        touch.at = foot.at;
      }
    }
    return deepest > 0.0;
  };
  double clear = specimen.high.z() + 2.0 * radius;
  double touching = clear;
  while (!touches(touching)) {
    if (touching < specimen.low.z())
      throw MeshError("the finger passes beside the specimen at x " +
                      quantity_text(touch.finger.x(), unit::mm) + ", y " +
                      quantity_text(touch.finger.y(), unit::mm) +
                      "; set `finger.x` and `finger.y` to a place above it");
    clear = touching;
    touching -= 0.25 * radius;
  }
  // To the last bit: two neighbouring numbers have no number between them.
  for (double middle = 0.5 * (clear + touching); middle > touching && middle < clear;
       middle = 0.5 * (clear + touching))
    (touches(middle) ? touching : clear) = middle;
  [[maybe_unused]] const bool reached = touches(touching);  // stores the touch at this height
  touch.finger.z() = clear;                                 // without contact force at zero travel
  return touch;
}

}  // namespace palpate::scene
