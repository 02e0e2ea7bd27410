// The smooth surface between the vertices: its order, its creases, and feet that do not jump.
#include "geometry/smooth_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/cuboid.h"
#include "geometry/shapes.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using geometry::BoxTree;
using geometry::SmoothSurface;
using geometry::Surface;
using geometry::SurfacePoint;
using test::Dice;

Surface box(const Vec3& size, std::array<int, 3> cells) {
  return geometry::outer_surface(geometry::cuboid(size, cells, geometry::CellPattern::mirrored))
      .surface;
}

// A wedge along y whose upper edge is sharper than a right angle: its sides rise at 60 degrees.
Surface wedge() {
  Surface surface;
  const double h = std::sqrt(3.0);
  for (const double y : {0.0, 4.0}) {
    surface.vertices.emplace_back(-1.0, y, -h);
    surface.vertices.emplace_back(1.0, y, -h);
    surface.vertices.emplace_back(0.0, y, 0.0);
  }
  surface.triangles = {{0, 1, 2}, {3, 5, 4}, {1, 4, 5}, {1, 5, 2},
                       {0, 2, 5}, {0, 5, 3}, {0, 3, 4}, {0, 4, 1}};
  return surface;
}

struct Searched {
  SmoothSurface smooth;
  BoxTree tree;
  explicit Searched(const Surface& surface) : smooth(surface), tree(surface) {}
  [[nodiscard]] SmoothSurface::ClosestPoint closest_point(const Vec3& point) const {
    return smooth.closest_point(point, tree.nearest(point));
  }
};

TEST(SmoothSurface, IsTheFlatItselfOnFlats) {
  const Vec3 size(0.06, 0.05, 0.03);
  const Searched block(box(size, {5, 6, 3}));
  Dice dice(1);
  for (int i = 0; i < 200; ++i) {
    const double x = size.x() * (0.02 + 0.96 * dice.roll());
    const double y = size.y() * (0.02 + 0.96 * dice.roll());
    const double up = 0.02 * dice.roll() - 0.0009;  // not deeper than the sides are far
    const auto closest_point = block.closest_point({x, y, size.z() + up});
    EXPECT_EQ(closest_point.normal, Vec3::UnitZ());
    EXPECT_EQ(closest_point.position.z(), size.z());
    EXPECT_NEAR((closest_point.position - Vec3(x, y, size.z())).norm(), 0.0,
                1e-16);  // rounding of weights
    EXPECT_EQ(closest_point.height, size.z() + up - size.z());
    EXPECT_FALSE(closest_point.on_crease);
  }
  for (std::size_t t = 0; t < block.smooth.surface().triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3& normal = block.smooth.corner_normal(static_cast<int>(t), corner);
      EXPECT_EQ(normal.cwiseAbs().maxCoeff(), 1.0);
      EXPECT_EQ(normal.cwiseAbs().sum(), 1.0);
    }
}

// Distance from the nearest point of the triangles is all that a foot on them has.
TEST(SmoothSurface, IsItsTrianglesWhereEveryEdgeIsACrease) {
  const Surface ball = geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(2.0), 0.6);
  const SmoothSurface flat(ball, 2.0);
  const SmoothSurface smooth(ball);
  const BoxTree tree(ball);
  Dice dice(3);
  double most = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 point =
        1.2 * Vec3(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5).normalized();
    const geometry::Near near = tree.nearest(point);
    const Vec3 own = flat.flat_position({near.triangle, near.weights});
    EXPECT_NEAR((flat.closest_point(point, near).position - own).norm(), 0.0, 1e-6);
    most = std::max(most, (smooth.closest_point(point, near).position - own).norm());
  }
  EXPECT_GT(most, 0.01);  // which the smooth surface is not
}

int creases(const Surface& surface) {
  const SmoothSurface smooth(surface);
  int count = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t edge = 0; edge < 3; ++edge)
      count += smooth.crease(static_cast<int>(t), edge) ? 1 : 0;
  return count;
}

// A house with a ridge of 150 degrees: its roof, of four triangles, is no rounded surface. The
// sides of a prism with bends of the same size are a cylinder, and its ends are not.
TEST(SmoothSurface, KnowsABluntRidgeFromACylinder) {
  const auto prism = [](const std::vector<Vec3>& outline) {
    Surface surface;
    const int n = static_cast<int>(outline.size());
    for (const double y : {0.0, 3.0})
      for (const Vec3& corner : outline) surface.vertices.emplace_back(corner.x(), y, corner.z());
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n;
      surface.triangles.push_back({i, next + n, i + n});
      surface.triangles.push_back({i, next, next + n});
      if (i > 0 && i + 1 < n) {
        surface.triangles.push_back({0, next, i});
        surface.triangles.push_back({n, i + n, next + n});
      }
    }
    return surface;
  };
  const double rise = 2.0 * std::tan(15.0 / 180.0 * M_PI);
  // Clockwise as seen along y: the normals point outwards.
  const Surface house = prism({{-2, 0, 0}, {-2, 0, 1}, {0, 0, 1.0 + rise}, {2, 0, 1}, {2, 0, 0}});
  ASSERT_GT(geometry::enclosed(house).volume, 0.0);
  EXPECT_EQ(creases(house), 2 * (3 * 5));  // five lines along y and five at each end
  std::vector<Vec3> round;
  for (int i = 0; i < 12; ++i)
    round.emplace_back(-std::cos(i * M_PI / 6.0), 0.0, std::sin(i * M_PI / 6.0));
  EXPECT_EQ(creases(prism(round)), 2 * (2 * 12));  // the ends alone
  EXPECT_EQ(creases(geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(2.0), 0.5)), 0);
}

// A foot's errors over points near the surface: the greatest in height, the mean in the normal.
struct Errors {
  double height = 0.0, normal = 0.0;
};

// `height(x)` and `normal(x)` of the true surface seen from a point x near it.
template <class Height, class Normal, class Point>
Errors errors(const Surface& surface, const Point& point, const Height& height,
              const Normal& normal) {
  const Searched searched(surface);
  Dice dice(7);
  constexpr int points = 400;
  Errors worst;
  for (int i = 0; i < points; ++i) {
    const Vec3 x = point(dice.roll(), dice.roll(), 0.4 * (dice.roll() - 0.2));
    const auto closest_point = searched.closest_point(x);
    worst.height = std::max(worst.height, std::abs(closest_point.height - height(x)));
    worst.normal += (closest_point.normal - normal(x)).norm() / points;
  }
  return worst;
}

// Halving the edges must take the error in height down by 2^2 and more, the normal's by 2.
template <class Make, class Point, class Height, class Normal>
void expect_second_order(const char* name, const Make& make, const Point& point,
                         const Height& height, const Normal& normal) {
  const Errors coarse = errors(make(0.2), point, height, normal);
  const Errors fine = errors(make(0.05), point, height, normal);
  // Two halvings. The constant differs between irregular meshes: a fifth of an order is left to it.
  EXPECT_GT(std::log2(coarse.height / fine.height) / 2.0, 1.8) << name;
  EXPECT_GT(std::log2(coarse.normal / fine.normal) / 2.0, 0.8) << name;
  // Against the flat triangles, whose greatest error is about l^2 / 8 in height.
  EXPECT_LT(fine.height, 0.05 * 0.05 / 8.0) << name;
}

TEST(SmoothSurface, FollowsSphereCylinderSaddleAndTorusToSecondOrder) {
  const double turn = 2.0 * std::numbers::pi;
  expect_second_order(
      "sphere", [](double edge) { return test::sphere(static_cast<int>(1.1 / edge), 0.2).surface; },
      [&](double u, double v, double up) -> Vec3 {
        const double z = 2.0 * u - 1.0;
        const double r = std::sqrt(1.0 - z * z);
        return (1.0 + up) * Vec3(r * std::cos(turn * v), r * std::sin(turn * v), z);
      },
      [](const Vec3& x) { return x.norm() - 1.0; },
      [](const Vec3& x) -> Vec3 { return x.normalized(); });
  expect_second_order(
      "cylinder", [](double edge) { return test::cylinder(edge).surface; },
      [&](double u, double v, double up) -> Vec3 {
        return {(1.0 + up) * std::cos(turn * u), (1.0 + up) * std::sin(turn * u), 1.0 + 2.0 * v};
      },
      [](const Vec3& x) { return std::hypot(x.x(), x.y()) - 1.0; },
      [](const Vec3& x) -> Vec3 { return Vec3(x.x(), x.y(), 0.0).normalized(); });
  const auto from_ring = [](const Vec3& x) -> Vec3 {
    return x - 3.0 * Vec3(x.x(), x.y(), 0.0).normalized();
  };
  expect_second_order(
      "torus", [](double edge) { return test::torus(edge).surface; },
      [&](double u, double v, double up) -> Vec3 {
        const double r = 3.0 + (1.0 + up) * std::cos(turn * v);
        return {r * std::cos(turn * u), r * std::sin(turn * u), (1.0 + up) * std::sin(turn * v)};
      },
      [&](const Vec3& x) { return from_ring(x).norm() - 1.0; },
      [&](const Vec3& x) -> Vec3 { return from_ring(x).normalized(); });
  // Of the saddle the foot is chosen first, and the point stands above it.
  struct Above {
    Vec3 normal;
    double up;
  } above{};
  expect_second_order(
      "saddle", [](double edge) { return test::saddle(edge).surface; },
      [&](double u, double v, double up) -> Vec3 {
        const double x = 0.5 - u;
        const double y = 0.5 - v;
        above = {Vec3(-x, y, 1.0).normalized(), up};
        return Vec3(x, y, 0.5 * (x * x - y * y)) + up * above.normal;
      },
      [&](const Vec3&) { return above.up; }, [&](const Vec3&) { return above.normal; });
}

// Along a path in small steps the height changes by at most the step, as a distance must, and the
// normal by at most `turning` radians a step.
void expect_no_jumps(const char* name, const Searched& searched, const Vec3& from, const Vec3& to,
                     double curvature) {
  constexpr int steps = 4000;
  auto before = searched.closest_point(from);
  const double step = (to - from).norm() / steps;
  double worst_height = 0.0;
  double worst_normal = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const Vec3 point = from + (to - from) * (static_cast<double>(i) / steps);
    const auto now = searched.closest_point(point);
    worst_height = std::max(worst_height, std::abs(now.height - before.height));
    worst_normal = std::max(worst_normal, (now.normal - before.normal).norm());
    before = now;
  }
  // The normals of the corners are blended, not exact: slopes of up to twice the true ones.
  EXPECT_LE(worst_height, 1.1 * step) << name;
  EXPECT_LE(worst_normal, 2.5 * curvature * step) << name;
}

TEST(SmoothSurface, FeetDoNotJumpOnCurvedSurfaces) {
  const Searched ball(test::sphere(8, 0.2).surface);
  expect_no_jumps("sphere outside", ball, {-1.0, 0.13, 1.1}, {1.0, 0.21, 1.2}, 1.0);
  expect_no_jumps("sphere inside", ball, {-0.3, 0.13, 0.8}, {0.3, 0.21, 0.8}, 1.7);
  const Searched bar(test::cylinder(0.2).surface);
  expect_no_jumps("cylinder", bar, {1.1, -1.0, 1.0}, {1.2, 1.0, 3.0}, 1.0);
  const Searched ring(test::torus(0.25).surface);
  expect_no_jumps("torus", ring, {-4.2, -1.0, 0.6}, {-2.6, 1.0, 1.0}, 1.7);
  const Searched valley(test::saddle(0.15).surface);
  expect_no_jumps("saddle", valley, {-0.6, -0.3, 0.35}, {0.6, 0.4, 0.3}, 1.5);
}

TEST(SmoothSurface, FeetDoNotJumpOverCreases) {
  const Searched block(box({0.06, 0.05, 0.03}, {5, 6, 3}));
  // Off the rim and around it; a normal turns by 1 / distance there.
  expect_no_jumps("over an edge", block, {0.03, 0.024, 0.05}, {0.08, 0.026, 0.025}, 100.0);
  expect_no_jumps("over a corner", block, {0.05, 0.04, 0.04}, {0.07, 0.06, 0.03}, 120.0);
  const Searched sharp(wedge());
  expect_no_jumps("over an acute edge", sharp, {-1.5, 2.1, 0.5}, {1.5, 1.7, 0.4}, 4.0);
  const Searched bar(geometry::sampled(geometry::Cylinder{.radius = 0.03, .length = 0.08},
                                       {.outer = 0.006, .inner = 0.006})
                         .parts[0]
                         .surface);
  expect_no_jumps("off a bar's end", bar, {0.031, 0.06, 0.07}, {0.036, 0.095, 0.069}, 120.0);
  expect_no_jumps("down a bar's end", bar, {0.031, 0.087, 0.075}, {0.036, 0.09, 0.03}, 150.0);
}

TEST(SmoothSurface, KnowsInsideFromOutside) {
  const Vec3 size(0.06, 0.05, 0.03);
  const Searched block(box(size, {5, 6, 3}));
  const Searched sharp(wedge());
  Dice dice(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 point(0.12 * dice.roll() - 0.03, 0.11 * dice.roll() - 0.03,
                     0.09 * dice.roll() - 0.03);
    const bool inside = (point.array() > 0.0).all() && (point.array() < size.array()).all();
    const Vec3 away = point.cwiseMax(0.0).cwiseMin(size) - point;
    const double depth = std::min(point.minCoeff(), (size - point).minCoeff());
    EXPECT_NEAR(block.closest_point(point).height, inside ? -depth : away.norm(), 1e-15);

    const Vec3 x(6.0 * dice.roll() - 3.0, 4.0 * dice.roll(), 5.0 * dice.roll() - 3.0);
    const double low = std::sqrt(3.0);
    const bool within = x.z() > -low && x.z() < 0.0 && std::abs(x.x()) < -x.z() / std::sqrt(3.0);
    EXPECT_EQ(sharp.closest_point(x).height < 0.0, within) << x.transpose();
  }
}

TEST(SmoothSurface, RimPointsSayThatTheyAreOnACrease) {
  const Searched block(box({0.06, 0.05, 0.03}, {5, 6, 3}));
  const auto rim = block.closest_point({0.063, 0.02, 0.034});
  EXPECT_TRUE(rim.on_crease);
  EXPECT_NEAR(rim.height, 0.005, 1e-15);
  EXPECT_NEAR((rim.normal - Vec3(0.6, 0.0, 0.8)).norm(), 0.0, 1e-13);  // rounding over 5 mm
  // From one side's normal to the other's: 0.6 beyond the one and 0.8 beyond the other.
  const auto& near = block.smooth.corner_normal(rim.at.triangle, 0);
  const auto& far = block.smooth.corner_normal(rim.beyond.triangle, 0);
  EXPECT_EQ(near + far, Vec3(1.0, 0.0, 1.0));
  EXPECT_NEAR(rim.turned, (near == Vec3::UnitZ() ? 0.6 : 0.8) / 1.4, 1e-13);
  EXPECT_EQ(block.closest_point({0.03, 0.02, 0.034}).turned, 0.0);
}

}  // namespace
}  // namespace palpate
