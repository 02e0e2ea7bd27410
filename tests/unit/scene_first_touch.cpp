// Where a finger first touches a surface.
#include "scene/first_touch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geometry/body.h"
#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"

namespace palpate {
namespace {

// On a narrow ridge of facets the finger had stopped 2 mm above it, and pressed nothing.
TEST(FirstTouch, IsARadiusFromWhatItTouches) {
  geometry::Surface body =
      geometry::sampled(geometry::Ellipsoid{{0.14, 0.1, 0.08}}, {2.8e-3, 2.8e-3})
          .parts.front()
          .surface;
  for (Vec3& vertex : body.vertices)
    if (vertex.z() > 0.04)
      vertex.z() += 12e-3 * std::exp(-0.5 * std::pow((vertex.x() - 0.075) / 1.7e-3, 2));
  const geometry::SmoothSurface smooth(body);
  constexpr double radius = 8e-3;
  const std::array<Vec3, 1> one{Vec3::Zero()};
  for (const double y : {0.048, 0.05, 0.052}) {
    const scene::FirstTouch touch = scene::lowered_onto(smooth, {0.075, y, 0.1}, {one, radius});
    EXPECT_NEAR((touch.finger - smooth.position(touch.at)).norm(), radius, 2e-3 * radius) << y;
  }
}

}  // namespace
}  // namespace palpate
