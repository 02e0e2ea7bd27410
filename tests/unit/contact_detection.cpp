// Which contacts a sphere has with a surface, wherever it comes from and however the surface moved.
#include "contact/detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cuboid.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using contact::Detector;
using geometry::SmoothSurface;
using geometry::Surface;
using test::Dice;
using Feet = std::vector<SmoothSurface::ClosestPoint>;

Surface box(const Vec3& size, std::array<int, 3> cells) {
  return geometry::outer_surface(geometry::cuboid(size, cells, geometry::CellPattern::mirrored))
      .surface;
}

// z = height(x, y) over [-1, 1]^2, outside upwards.
template <class Height>
Surface land(int cells, const Height& height, double jitter = 0.25) {
  return test::split_quads({.cells = {cells, cells}, .wraps = {false, false}, .jitter = jitter},
                           [&](double u, double v) -> Vec3 {
                             const double x = 2.0 * u - 1.0;
                             const double y = 2.0 * v - 1.0;
                             return {x, y, height(x, y)};
                           });
}

Feet find(const SmoothSurface& smooth, const Vec3& centre, double radius) {
  Detector detector(smooth);
  Feet feet;
  detector.find(centre, radius, {}, feet);
  return feet;
}

TEST(Detection, OneOnAFlatAtAnyDepth) {
  const SmoothSurface block(box({0.06, 0.06, 0.03}, {7, 6, 4}));
  Dice dice(1);
  for (int i = 0; i < 300; ++i) {
    // Down to where another face is nearer than the top.
    const double height = 0.0109 - 0.0179 * dice.roll();
    const Vec3 centre(0.015 + 0.03 * dice.roll(), 0.015 + 0.03 * dice.roll(), 0.03 + height);
    const Feet feet = find(block, centre, 0.011);
    ASSERT_EQ(feet.size(), 1U) << height;
    EXPECT_EQ(feet[0].normal, Vec3::UnitZ());
    EXPECT_NEAR(feet[0].height, height, 1e-16);
  }
  EXPECT_TRUE(find(block, {0.03, 0.03, 0.03 + 0.0110001}, 0.011).empty());
}

// Centres on vertices, edges and diagonals of the mesh, where several triangles are equally near.
TEST(Detection, NeverTheSameContactTwice) {
  const SmoothSurface block(box({0.06, 0.06, 0.03}, {6, 6, 3}));
  for (int i = 4; i <= 20; ++i)
    for (int j = 4; j <= 20; ++j)
      EXPECT_EQ(find(block, {0.0025 * i, 0.0025 * j, 0.04}, 0.011).size(), 1U) << i << " " << j;
  const auto ball_surface = test::sphere(6, 0.2).surface;
  const SmoothSurface ball(ball_surface);
  for (const Vec3& vertex : ball_surface.vertices)
    EXPECT_EQ(find(ball, 1.2 * vertex, 0.3).size(), 1U);
  for (const auto& [a, b, c] : ball_surface.triangles) {
    const Vec3 middle = 0.5 * (ball_surface.vertices[static_cast<std::size_t>(a)] +
                               ball_surface.vertices[static_cast<std::size_t>(b)]);
    EXPECT_EQ(find(ball, 1.2 * middle, 0.3).size(), 1U);
  }
}

TEST(Detection, OneOutsideABallAndFromDeepInside) {
  const SmoothSurface ball(test::sphere(8, 0.2).surface);
  Dice dice(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 way = Vec3(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5).normalized();
    const double distance = 0.4 + 0.85 * dice.roll();  // of the centre of a sphere of 0.3
    const Feet feet = find(ball, distance * way, 0.3);
    ASSERT_EQ(feet.size(), 1U) << distance;
    EXPECT_NEAR(feet[0].height, distance - 1.0, 0.005);  // edges of 0.14: l^2 / 8 is 0.0025
  }
}

TEST(Detection, BothSidesOfAGroove) {
  // Rises at 45 degrees to both sides of x = 0.
  const SmoothSurface groove(land(
      10, [](double x, double) { return std::abs(x); }, 0.0));
  for (const double x : {0.0, 0.01, -0.05}) {
    const Feet feet = find(groove, {x, 0.07, 0.5}, 0.45);
    ASSERT_EQ(feet.size(), 2U) << x;
    const double root = std::sqrt(0.5);
    double left = 0.0, right = 0.0;
    for (const auto& closest_point : feet)
      (closest_point.position.x() < 0.0 ? left : right) = closest_point.height;
    EXPECT_NEAR(left, root * (0.5 + x), 1e-12);
    EXPECT_NEAR(right, root * (0.5 - x), 1e-12);
  }
}

TEST(Detection, TwoSeparateBumps) {
  const SmoothSurface bumps(land(40, [](double x, double y) {
    const double left = (x + 0.5) * (x + 0.5) + y * y;
    const double right = (x - 0.5) * (x - 0.5) + y * y;
    return 0.3 / (1.0 + 12.0 * left) + 0.3 / (1.0 + 12.0 * right);
  }));
  const Feet feet = find(bumps, {0.0, 0.0, 1.1}, 0.97);
  ASSERT_EQ(feet.size(), 2U);
  for (const auto& closest_point : feet) {
    EXPECT_NEAR(std::abs(closest_point.position.x()), 0.45, 0.1);
    EXPECT_NEAR(closest_point.position.y(), 0.0, 0.05);
  }
  EXPECT_EQ(find(bumps, {0.1, 0.0, 1.12}, 0.92).size(), 1U);  // the nearer one alone
  // Neither do they become one where the surface has moved.
  Detector detector(bumps);
  std::vector<Vec3> displacement;
  for (const Vec3& x : bumps.surface().vertices)
    displacement.emplace_back(0.01 * x.y(), -0.01 * x.x(), -0.02 * x.squaredNorm());
  detector.refit(displacement);
  Feet moved;
  detector.find({0.0, 0.0, 1.1}, 0.98, displacement, moved);
  EXPECT_EQ(moved.size(), 2U);
}

TEST(Detection, TheFarSideOfAPlateIsNoContact) {
  const SmoothSurface plate(box({0.06, 0.06, 0.002}, {12, 12, 1}));
  Dice dice(3);
  for (int i = 0; i < 200; ++i) {
    const double height = 0.0109 * dice.roll();
    const Feet feet =
        find(plate, {0.02 + 0.02 * dice.roll(), 0.02 + 0.02 * dice.roll(), 0.002 + height}, 0.011);
    ASSERT_EQ(feet.size(), 1U);
    EXPECT_EQ(feet[0].normal, Vec3::UnitZ());
  }
}

TEST(Detection, ASphereThatMovedSeveralRadiiInOneCall) {
  const SmoothSurface block(box({0.06, 0.06, 0.03}, {7, 6, 4}));
  Detector detector(block);
  Feet feet;
  detector.find({0.03, 0.03, 0.2}, 0.011, {}, feet);
  EXPECT_TRUE(feet.empty());
  detector.find({0.02, 0.04, 0.035}, 0.011, {}, feet);  // from 15 radii away
  ASSERT_EQ(feet.size(), 1U);
  EXPECT_NEAR(feet[0].height, 0.005, 1e-16);
  detector.find({-0.005, 0.03, 0.015}, 0.011, {}, feet);  // to another side
  ASSERT_EQ(feet.size(), 1U);
  EXPECT_EQ(feet[0].normal, -Vec3::UnitX());
}

// The local minima of the distance over all triangles, looked for in all of them.
std::size_t minima(const Surface& surface, const Vec3& centre, double radius, Vec3& nearest) {
  std::vector<double> distance;
  std::vector<Vec3> feet;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& p = surface.vertices[static_cast<std::size_t>(a)];
    const Vec3& q = surface.vertices[static_cast<std::size_t>(b)];
    const Vec3& r = surface.vertices[static_cast<std::size_t>(c)];
    const Vec3 weights = geometry::nearest_weights(centre, p, q, r);
    feet.emplace_back(weights[0] * p + weights[1] * q + weights[2] * r);
    distance.push_back((feet.back() - centre).norm());
    if (distance.back() < least) {
      least = distance.back();
      nearest = feet.back();
    }
  }
  const geometry::Neighbours neighbours(surface);
  std::vector<Vec3> found;
  for (std::size_t t = 0; t < distance.size(); ++t) {
    if (distance[t] > radius) continue;
    bool is_least = true;
    for (const int vertex : surface.triangles[t])
      for (const int other : neighbours.triangles_at(vertex))
        is_least = is_least && distance[static_cast<std::size_t>(other)] >= distance[t] - 1e-12;
    if (is_least && std::none_of(found.begin(), found.end(),
                                 [&](const Vec3& x) { return (x - feet[t]).norm() < 1e-9; }))
      found.push_back(feet[t]);
  }
  return found.size();
}

TEST(Detection, EqualsALookAtEveryTriangle) {
  const Surface surface = land(30, [](double x, double y) {
    return 0.15 * std::sin(7.0 * x) * std::cos(6.0 * y) + 0.1 * x;
  });
  const SmoothSurface smooth(surface);
  Detector detector(smooth);
  Feet feet;
  Dice dice(9);
  int several = 0;
  int differ = 0;
  constexpr int poses = 600;
  for (int i = 0; i < poses; ++i) {
    const Vec3 centre(dice.roll() - 0.5, dice.roll() - 0.5, 0.25 + 0.35 * dice.roll());
    const double radius = 0.1 + 0.5 * dice.roll();
    Vec3 nearest = Vec3::Zero();
    const std::size_t expected = minima(surface, centre, radius, nearest);
    detector.find(centre, radius, {}, feet);
    several += feet.size() > 1 ? 1 : 0;
    differ += feet.size() != expected ? 1 : 0;
    if (expected == 0) continue;
    // The nearest of all is among them, as far as the smooth surface is from the flat triangles.
    double miss = std::numeric_limits<double>::infinity();
    for (const auto& closest_point : feet)
      miss = std::min(miss, std::abs((centre - nearest).norm() - closest_point.height));
    EXPECT_LT(miss, 0.01) << i;
  }
  EXPECT_GT(several, poses / 20);  // else nothing is tested
  // Where a sphere just grazes, or two minima are about to merge, flat and smooth may differ.
  EXPECT_LE(differ, poses / 20);
}

TEST(Detection, FindsTheSurfaceWhereItIsNow) {
  const Surface surface = box({0.06, 0.06, 0.03}, {12, 12, 4});
  const SmoothSurface smooth(surface);
  Detector detector(smooth);
  Feet feet;
  // Moved far as a whole: 5 radii up and 3 along.
  const Vec3 away(0.033, 0.0, 0.055);
  std::vector<Vec3> displacement(surface.vertices.size(), away);
  detector.refit(displacement);
  detector.find(Vec3(0.03, 0.03, 0.04) + away, 0.011, displacement, feet);
  ASSERT_EQ(feet.size(), 1U);
  EXPECT_NEAR(feet[0].height, 0.01, 1e-16);
  EXPECT_NEAR((feet[0].position - Vec3(0.03, 0.03, 0.03)).norm(), 0.0, 1e-15);  // at rest
  detector.find({0.03, 0.03, 0.04}, 0.011, displacement, feet);                 // where it was
  EXPECT_TRUE(feet.empty());
  // Stretched to twice its height, without turning: the top at 60 mm sinks nowhere sideways.
  for (std::size_t v = 0; v < displacement.size(); ++v)
    displacement[v] = Vec3(0.0, 0.0, surface.vertices[v].z());
  detector.refit(displacement);
  detector.find({0.03, 0.03, 0.07}, 0.011, displacement, feet);
  ASSERT_EQ(feet.size(), 1U);
  EXPECT_NEAR(feet[0].height, 0.01, 1e-15);
}

// Under a contact the surface takes the shape of the sphere, so that every point there is about as
// near as any other: it is one contact all the same.
TEST(Detection, OneContactOnASurfaceThatTookTheSpheresShape) {
  const Surface surface = box({0.06, 0.06, 0.03}, {24, 24, 4});
  const SmoothSurface smooth(surface);
  Detector detector(smooth);
  constexpr double radius = 0.011;
  const Vec3 centre(0.0304, 0.0291, 0.03 + radius - 0.002);
  Dice dice(6);
  Feet feet;
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec3> displacement(surface.vertices.size(), Vec3::Zero());
    for (std::size_t v = 0; v < displacement.size(); ++v) {
      const Vec3& x = surface.vertices[v];
      const Vec3 arm(x.x() - centre.x(), x.y() - centre.y(), 0.0);
      if (x.z() < 0.03 || arm.norm() >= radius) continue;
      // On the sphere up to 4.5 mm from its axis, a little rough, and drawn towards the middle by
      // up to a tenth of a millimetre.
      displacement[v] = -0.08 * arm / (1.0 + arm.squaredNorm() / 1e-5);
      const double r2 = (arm + displacement[v]).squaredNorm();
      const double sphere = centre.z() - std::sqrt(radius * radius - r2);
      displacement[v].z() = std::min(0.0, sphere - 0.03 + 2e-5 * (dice.roll() - 0.5));
    }
    detector.refit(displacement);
    detector.find(centre, radius, displacement, feet);
    EXPECT_EQ(feet.size(), 1U) << i;
  }
}

}  // namespace
}  // namespace palpate
