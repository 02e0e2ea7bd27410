// A Hertz pressure spread over vertices: its sum, its centre, and no jumps.
#include "contact/patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "geometry/cuboid.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using contact::Patch;
using contact::Spread;
using contact::Spreader;
using geometry::BoxTree;
using geometry::SmoothSurface;
using test::Dice;

const Vec3 block_size(0.06, 0.06, 0.03);

geometry::Surface block() {
  return geometry::outer_surface(
             geometry::cuboid(block_size, {7, 6, 4}, geometry::CellPattern::mirrored))
      .surface;
}

// Over the foot below `point`, its long axis turned by `angle` from an arbitrary direction.
Patch patch_below(const SmoothSurface& smooth, const BoxTree& tree, const Vec3& point,
                  double angle) {
  const auto closest_point = smooth.closest_point(point, tree.nearest(point));
  Patch patch;
  patch.at = closest_point.at;
  patch.position = closest_point.position;
  patch.normal = closest_point.normal;
  patch.axis =
      Eigen::AngleAxisd(angle, closest_point.normal) * closest_point.normal.unitOrthogonal();
  return patch;
}

// How far the spread is off: from a sum of 1, and its centre from the patch's in the tangent plane.
struct Off {
  double sum = -1.0;
  Vec3 centre = Vec3::Zero();  // m
};
Off off(const SmoothSurface& smooth, const Patch& patch, const Spread& spread) {
  Off off;
  for (std::size_t j = 0; j < spread.vertices.size(); ++j) {
    EXPECT_GE(spread.shares[j], 0.0);
    if (j > 0) {
      EXPECT_GT(spread.vertices[j], spread.vertices[j - 1]);
    }
    off.sum += spread.shares[j];
    const Vec3 arm =
        smooth.surface().vertices[static_cast<std::size_t>(spread.vertices[j])] - patch.position;
    off.centre += spread.shares[j] * (arm - arm.dot(patch.normal) * patch.normal);
  }
  return off;
}

void expect_balanced(const SmoothSurface& smooth, Spreader& spreader, const Patch& patch) {
  Spread spread;
  spreader.spread(patch, spread);
  const Off wrong = off(smooth, patch, spread);
  EXPECT_LE(std::abs(wrong.sum), 1e-12);  // 96 weights from 18 printed digits
  const double length = patch.position.norm() + patch.a;
  EXPECT_LE(wrong.centre.norm(), 1e-9 * patch.a + 1e-12 * length) << patch.a << " " << patch.b;
}

TEST(Spread, SumsToOneAndCentresOnThePatchOnAFlat) {
  const SmoothSurface smooth(block());
  const BoxTree tree(smooth.surface());
  Spreader spreader(smooth);
  Dice dice(3);
  for (int i = 0; i < 60; ++i) {
    Patch patch = patch_below(smooth, tree, {0.06 * dice.roll(), 0.06 * dice.roll(), 0.031},
                              6.0 * dice.roll());
    patch.a = 0.012 * dice.roll();
    patch.b = i % 3 == 0 ? patch.a : patch.a * dice.roll();
    expect_balanced(smooth, spreader, patch);  // also where it hangs over the rim
  }
}

TEST(Spread, SumsToOneAndCentresOnThePatchOnCurvedSurfaces) {
  for (const auto& surface : {test::sphere(7, 0.2).surface, test::cylinder(0.25).surface,
                              test::torus(0.3).surface, test::saddle(0.2).surface}) {
    const SmoothSurface smooth(surface);
    const BoxTree tree(surface);
    Spreader spreader(smooth);
    Dice dice(4);
    for (int i = 0; i < 60; ++i) {
      const auto vertex =
          static_cast<std::size_t>(dice.roll() * static_cast<double>(surface.vertices.size()));
      const Vec3 shake(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5);
      Patch patch =
          patch_below(smooth, tree, surface.vertices[vertex] + 0.3 * shake, 6.0 * dice.roll());
      patch.a = 0.5 * dice.roll();
      patch.b = patch.a * dice.roll();
      expect_balanced(smooth, spreader, patch);
    }
  }
}

TEST(Spread, APointLoadsItsOwnTriangle) {
  const SmoothSurface smooth(block());
  const BoxTree tree(smooth.surface());
  Spreader spreader(smooth);
  const Patch patch = patch_below(smooth, tree, {0.0271, 0.0234, 0.04}, 0.0);
  Spread spread;
  spreader.spread(patch, spread);
  ASSERT_LE(spread.vertices.size(), 3U);
  const Off wrong = off(smooth, patch, spread);
  EXPECT_LE(std::abs(wrong.sum), 1e-12);
  EXPECT_LE(wrong.centre.norm(), 1e-15);  // rounding of 60 mm
}

// The second moments of the Hertz pressure over an ellipse are a^2 / 5 and b^2 / 5. On a mesh much
// finer than the patch the shares must have them along its axes: so the ellipse is neither turned
// nor mistaken for a circle.
TEST(Spread, HasTheEllipsesSecondMoments) {
  const SmoothSurface smooth(
      geometry::outer_surface(
          geometry::cuboid(Vec3(0.06, 0.06, 0.002), {120, 120, 1}, geometry::CellPattern::mirrored))
          .surface);
  const BoxTree tree(smooth.surface());
  Spreader spreader(smooth);
  Spread spread;
  for (const double angle : {0.0, 0.4, 1.3, 2.5}) {
    Patch patch = patch_below(smooth, tree, {0.0303, 0.0298, 0.01}, angle);
    patch.a = 0.010;
    patch.b = 0.004;
    spreader.spread(patch, spread);
    const Vec3 across = patch.normal.cross(patch.axis);
    double along_along = 0.0, across_across = 0.0, mixed = 0.0;
    for (std::size_t j = 0; j < spread.vertices.size(); ++j) {
      const Vec3 arm =
          smooth.surface().vertices[static_cast<std::size_t>(spread.vertices[j])] - patch.position;
      along_along += spread.shares[j] * arm.dot(patch.axis) * arm.dot(patch.axis);
      across_across += spread.shares[j] * arm.dot(across) * arm.dot(across);
      mixed += spread.shares[j] * arm.dot(patch.axis) * arm.dot(across);
    }
    // Linear shape functions of 0.5 mm cells add up to h^2 / 4 = 0.06 mm^2 to 20 and 3.2 mm^2.
    EXPECT_NEAR(along_along, patch.a * patch.a / 5.0, 0.07e-6);
    EXPECT_NEAR(across_across, patch.b * patch.b / 5.0, 0.07e-6);
    EXPECT_NEAR(mixed, 0.0, 0.07e-6);
  }
}

double change(const Spread& a, const Spread& b) {
  std::map<int, double> shares;
  for (std::size_t j = 0; j < a.vertices.size(); ++j) shares[a.vertices[j]] += a.shares[j];
  for (std::size_t j = 0; j < b.vertices.size(); ++j) shares[b.vertices[j]] -= b.shares[j];
  double sum = 0.0;
  for (const auto& [vertex, difference] : shares) sum += std::abs(difference);
  return sum;
}

TEST(Spread, ChangesContinuouslyWithItsAxes) {
  const SmoothSurface smooth(block());
  const BoxTree tree(smooth.surface());
  Spreader spreader(smooth);
  Patch patch = patch_below(smooth, tree, {0.051, 0.024, 0.04}, 0.7);  // reaches over the rim
  Spread before;
  Spread now;
  spreader.spread(patch, before);
  // A quadrature point that moves by dr on cells of 9 mm shifts at most 2 dr / (9 mm / sqrt(2)) of
  // its share, and drawing back to the rim moves it no faster than its arm grows.
  constexpr double step = 1e-5;
  for (double a = step; a < 0.015; a += step) {
    patch.a = a;
    patch.b = 0.6 * a;
    spreader.spread(patch, now);
    EXPECT_LE(change(before, now), 4.0 * step / 0.0064) << a;
    std::swap(before, now);
  }
}

TEST(Spread, ChangesContinuouslyAsItMoves) {
  const SmoothSurface flat(block());
  const BoxTree flat_tree(flat.surface());
  Spreader flat_spreader(flat);
  const auto ball_surface = test::sphere(8, 0.2, 0.03).surface;  // edges of 4 mm
  const SmoothSurface ball(ball_surface);
  const BoxTree ball_tree(ball_surface);
  Spreader ball_spreader(ball);
  Spread before;
  Spread now;
  constexpr double step = 1e-5;
  for (int i = 0; i < 3500; ++i) {  // up to the very rim at 60 mm
    Patch patch = patch_below(flat, flat_tree, {0.025 + i * step, 0.0301, 0.04}, 0.0);
    patch.axis = Vec3(0.8, 0.6, 0.0);
    patch.a = 0.004;
    patch.b = 0.003;
    flat_spreader.spread(patch, now);
    // As above; near the rim opposite points are drawn back, up to twice as fast as the centre
    // goes.
    if (i > 0) {
      EXPECT_LE(change(before, now), 8.0 * step / 0.0064) << i;
    }
    std::swap(before, now);
  }
  for (int i = 0; i < 3000; ++i) {
    const double angle = step * i / 0.03;
    Patch patch = patch_below(
        ball, ball_tree, 0.035 * Vec3(std::sin(angle), 0.1, std::cos(angle)).normalized(), 0.0);
    patch.axis = Vec3(0.0, 1.0, 0.0).cross(patch.normal).normalized();
    patch.a = 0.004;
    patch.b = 0.003;
    ball_spreader.spread(patch, now);
    if (i > 0) {
      EXPECT_LE(change(before, now), 8.0 * step / 0.003) << i;  // shaken edges of 3 mm
    }
    std::swap(before, now);
  }
}

// A side that falls steeply is turned away from the patch; one that falls at 60 degrees faces it,
// but lies beyond a crease.
TEST(Spread, DoesNotReachAroundTheRim) {
  for (const double shear : {0.0, 1.0 / std::sqrt(3.0)}) {
    geometry::Surface body = block();
    for (Vec3& vertex : body.vertices) vertex.x() += shear * (block_size.z() - vertex.z());
    const SmoothSurface smooth(body);
    const BoxTree tree(smooth.surface());
    Spreader spreader(smooth);
    Patch patch = patch_below(smooth, tree, {0.0595, 0.03, 0.04}, 0.0);
    patch.a = patch.b = 0.005;
    Spread spread;
    spreader.spread(patch, spread);
    for (const int vertex : spread.vertices)
      EXPECT_EQ(smooth.surface().vertices[static_cast<std::size_t>(vertex)].z(), block_size.z());
  }
}

}  // namespace
}  // namespace palpate
