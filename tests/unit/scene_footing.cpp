// What a body stands on.
#include "scene/footing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/shapes.h"

namespace palpate::scene {
namespace {

geometry::Surface surface_of(const geometry::Shape& shape, double spacing) {
  return geometry::sampled(shape, {spacing, spacing}).parts.front().surface;
}

TEST(Footing, OfACuboidHasTheMomentsOfItsUnderside) {
  const Footing found = footing(surface_of(geometry::Cuboid{{0.06, 0.02, 0.03}}, 5e-3), {});
  EXPECT_EQ(found.level, 0.0);
  EXPECT_NEAR(found.centre.x(), 0.03, 1e-12);
  EXPECT_NEAR(found.centre.y(), 0.01, 1e-12);
  // An ellipse has the second moment p^2 / 4, a rectangle w^2 / 12.
  EXPECT_NEAR(found.semi_axes[0], 0.02 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(found.semi_axes[1], 0.06 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(std::abs(found.direction.y()), 1.0, 1e-12);
}

// The lowest tenth of a sphere is a circle of the radius sqrt(0.1 (2 - 0.2)) R = 0.6 R.
TEST(Footing, OfASphereIsItsLowestTenth) {
  const geometry::Surface sphere = surface_of(geometry::Ellipsoid{{0.1, 0.1, 0.1}}, 1.5e-3);
  const Footing found = footing(sphere, {});
  for (const double half : found.semi_axes) EXPECT_NEAR(half, 0.03, 1e-3);
  const Footing lower = footing(sphere, 0.0025);  // sqrt(0.05 (1 - 0.0125)) of the diameter
  for (const double half : lower.semi_axes) EXPECT_NEAR(half, 0.0156, 1e-3);
}

TEST(Footing, YieldsMoreUnderAForceThatPassesBesideIt) {
  Footing circle;
  circle.semi_axes = {0.02, 0.02};
  const Vec3 up = Vec3::UnitZ();
  const auto middle = circle.under({0.0, 0.0, 0.05}, up);
  EXPECT_DOUBLE_EQ(middle.sinking, 0.4 / 0.02);
  EXPECT_EQ(middle.rocking, 0.0);
  const auto aside = circle.under({0.01, 0.0, 0.05}, up);
  EXPECT_EQ(aside.sinking, middle.sinking);
  EXPECT_DOUBLE_EQ(aside.rocking, 2.25 * 0.25 / 0.02);
  // An inclined force through the same point of the base.
  const Vec3 normal = Vec3(0.3, 0.0, 1.0).normalized();
  EXPECT_NEAR(circle.under({0.01 + 0.3 * 0.05, 0.0, 0.05}, normal).rocking, aside.rocking, 1e-9);
  // An ellipse of the half axes p and q turns about the other axis by 1 / (p^2 q).
  Footing oval;
  oval.semi_axes = {0.02, 0.04};
  EXPECT_DOUBLE_EQ(oval.under({0.01, 0.0, 0.05}, up).rocking, 0.5 * aside.rocking);
  EXPECT_DOUBLE_EQ(oval.under({0.0, 0.01, 0.05}, up).rocking, 0.25 * aside.rocking);
}

}  // namespace
}  // namespace palpate::scene
