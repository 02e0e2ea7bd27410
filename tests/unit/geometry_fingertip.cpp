// The fingertip: its count, volume, symmetry, proportions, and that it is a sound open surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/shapes.h"

namespace palpate::geometry {
namespace {

// Of the sphere of 11 mm that stands for a finger elsewhere.
const double volume_given = 4.0 / 3.0 * std::numbers::pi * std::pow(11e-3, 3);

double highest(const Surface& surface, int axis) {
  double most = -1.0;
  for (const Vec3& vertex : surface.vertices) most = std::max(most, vertex[axis]);
  return most;
}

double lowest(const Surface& surface, int axis) {
  double least = 1.0;
  for (const Vec3& vertex : surface.vertices) least = std::min(least, vertex[axis]);
  return least;
}

TEST(Fingertip, HasTheVolumeAskedFor) {
  for (const double volume : {1e-9, volume_given, 3e-5}) {
    const Enclosed inside = enclosed(with_closed_base(fingertip(volume)));
    EXPECT_NEAR(inside.volume, volume, 1e-14 * volume);  // rounding of 194 terms
  }
}

TEST(Fingertip, HasItsTriangles) {
  const Surface finger = fingertip(volume_given);
  EXPECT_EQ(finger.triangles.size(), 179u);
  EXPECT_EQ(finger.vertices.size(), 98u);
  const Surface closed = with_closed_base(finger);
  EXPECT_EQ(closed.triangles.size(), 194u);
  EXPECT_EQ(closed.triangles.size(), 2 * closed.vertices.size() - 4);  // Euler, genus 0
}

// Each edge of the closed finger lies between two triangles that run along it in opposite ways.
TEST(Fingertip, ClosesToAnOrientedSurface) {
  const Surface closed = with_closed_base(fingertip(volume_given));
  std::vector<std::array<int, 2>> sides;
  for (const auto& triangle : closed.triangles)
    for (std::size_t i = 0; i < 3; ++i) sides.push_back({triangle[i], triangle[(i + 1) % 3]});
  std::sort(sides.begin(), sides.end());
  EXPECT_EQ(std::adjacent_find(sides.begin(), sides.end()), sides.end());
  for (const auto& [from, to] : sides)
    EXPECT_TRUE(std::binary_search(sides.begin(), sides.end(), std::array<int, 2>{to, from}));
}

TEST(Fingertip, IsOpenOnlyAtItsBasePlane) {
  const Surface finger = fingertip(volume_given);
  const Neighbours neighbours(finger);
  int rim = 0;
  for (std::size_t v = 0; v < finger.vertices.size(); ++v) {
    const bool at_base = finger.vertices[v].x() == 0.0;
    EXPECT_EQ(neighbours.on_boundary(static_cast<int>(v)), at_base) << v;
    rim += at_base ? 1 : 0;
  }
  EXPECT_EQ(rim, 15);
}

TEST(Fingertip, IsItsMirrorImageToTheBit) {
  const Surface finger = fingertip(volume_given);
  for (const Vec3& vertex : finger.vertices) {
    const Vec3 image(vertex.x(), -vertex.y(), vertex.z());
    EXPECT_NE(std::find(finger.vertices.begin(), finger.vertices.end(), image),
              finger.vertices.end());
  }
  const Vec3 centre = enclosed(with_closed_base(finger)).centroid;
  EXPECT_NEAR(centre.y(), 0.0, 1e-17);  // rounding of 1e-2 m
}

TEST(Fingertip, HasTheProportionsOfAFinger) {
  const Surface finger = fingertip(volume_given);
  const double breadth = highest(finger, 1) - lowest(finger, 1);
  const double depth = highest(finger, 2) - lowest(finger, 2);
  EXPECT_GT(breadth, 16e-3);  // Dandekar 2003: 16 to 20 mm
  EXPECT_LT(breadth, 20e-3);
  EXPECT_NEAR(depth / breadth, 15.0 / 18.0, 1e-12);               // rounding
  EXPECT_NEAR(highest(finger, 0) / breadth, 26.0 / 18.0, 1e-12);  // rounding
}

// Every triangle faces away from the axis, so the surface does not fold.
TEST(Fingertip, FacesOutwards) {
  const Surface finger = fingertip(volume_given);
  const Vec3 inside = enclosed(with_closed_base(finger)).centroid;
  for (std::size_t t = 0; t < finger.triangles.size(); ++t) {
    const Vec3 normal = twice_area(finger, static_cast<int>(t));
    const Vec3& corner = finger.vertices[static_cast<std::size_t>(finger.triangles[t][0])];
    EXPECT_GT(normal.dot(corner - inside), 0.0) << t;
  }
}

// On the pad side the section is fuller than the ellipse of the nail side: half way out, an ellipse
// keeps 0.87 of its height.
TEST(Fingertip, HasAFlattishPad) {
  const Surface finger = fingertip(volume_given);
  const double bottom = lowest(finger, 2);
  int flat = 0;
  for (const Vec3& vertex : finger.vertices)
    if (vertex.z() < 0.95 * bottom && std::abs(vertex.y()) > 0.4 * highest(finger, 1)) ++flat;
  EXPECT_GE(flat, 8);  // two on each of the body's rings
}

TEST(Fingertip, ClosedSurfacesStayAsTheyAre) {
  const Surface closed = with_closed_base(fingertip(volume_given));
  EXPECT_EQ(with_closed_base(closed).vertices, closed.vertices);
}

}  // namespace
}  // namespace palpate::geometry
