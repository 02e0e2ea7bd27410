// The tree of boxes against a look at every triangle.
#include "geometry/box_tree.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "geometry/shapes.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using geometry::BoxTree;
using geometry::Near;
using geometry::Surface;
using test::Dice;

Vec3 point_in_cube(Dice& dice, double half) {
  Vec3 point;
  for (int i = 0; i < 3; ++i) point[i] = half * (2.0 * dice.roll() - 1.0);
  return point;
}

// The nearest point of a triangle by the feet on its plane and on its three edges: another way than
// the regions that nearest_weights tells apart.
double distance_squared(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  double best = std::numeric_limits<double>::infinity();
  const std::array corners{a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& from = corners[i];
    const Vec3 side = corners[(i + 1) % 3] - from;
    const double part = std::clamp((point - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (from + part * side - point).squaredNorm());
  }
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 closest_point = point - (point - a).dot(normal) * normal;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i)
    inside = inside &&
             (corners[(i + 1) % 3] - corners[i]).cross(closest_point - corners[i]).dot(normal) >= 0;
  return inside ? std::min(best, (closest_point - point).squaredNorm()) : best;
}

std::vector<double> all_distances(const Surface& surface, const Vec3& point) {
  std::vector<double> squares;
  for (const auto& [a, b, c] : surface.triangles)
    squares.push_back(distance_squared(point, surface.vertices[static_cast<std::size_t>(a)],
                                       surface.vertices[static_cast<std::size_t>(b)],
                                       surface.vertices[static_cast<std::size_t>(c)]));
  return squares;
}

void expect_brute_force(const BoxTree& tree, const Surface& surface, const Vec3& point,
                        double radius) {
  const auto squares = all_distances(surface, point);
  std::vector<Near> found;
  tree.within(point, radius, found);
  std::size_t next = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < squares.size(); ++t) {
    least = std::min(least, squares[t]);
    const bool listed = next < found.size() && found[next].triangle == static_cast<int>(t);
    if (listed) {
      EXPECT_NEAR(found[next].distance_squared, squares[t], 1e-14);  // rounding of sizes near 1
      ++next;
    } else if (squares[t] < radius * radius - 1e-14) {
      ADD_FAILURE() << "triangle " << t << " is missing";
    }
  }
  EXPECT_EQ(next, found.size()) << "not ascending, or twice";
  for (const Near& one : found) EXPECT_LE(one.distance_squared, radius * radius);

  const Near nearest = tree.nearest(point);
  EXPECT_NEAR(nearest.distance_squared, least, 1e-14);
  EXPECT_NEAR(nearest.weights.sum(), 1.0, 1e-15);
  EXPECT_GE(nearest.weights.minCoeff(), 0.0);
  const auto& [a, b, c] = surface.triangles[static_cast<std::size_t>(nearest.triangle)];
  const Vec3 at = nearest.weights[0] * surface.vertices[static_cast<std::size_t>(a)] +
                  nearest.weights[1] * surface.vertices[static_cast<std::size_t>(b)] +
                  nearest.weights[2] * surface.vertices[static_cast<std::size_t>(c)];
  EXPECT_NEAR((at - point).squaredNorm(), least, 1e-14);
}

TEST(BoxTree, EqualsALookAtEveryTriangle) {
  for (const Surface& surface : {test::torus(0.4, 3.0, {.seed = 3}).surface,
                                 test::sphere(6, 0.25).surface, test::saddle(0.2).surface}) {
    const BoxTree tree(surface);
    Dice dice(11);
    for (int i = 0; i < 60; ++i) {
      const Vec3 point = point_in_cube(dice, 4.0);
      expect_brute_force(tree, surface, point, 2.0 * dice.roll());
    }
  }
}

// The boxes follow even displacements that leave nothing of the order they were built in.
TEST(BoxTree, EqualsALookAtEveryTriangleAfterItMoved) {
  Surface surface = test::torus(0.4, 3.0, {.seed = 3}).surface;
  BoxTree tree(surface);
  Dice dice(5);
  for (const double size : {0.05, 0.5, 3.0}) {
    for (Vec3& vertex : surface.vertices) vertex += point_in_cube(dice, size);
    tree.refit(surface.vertices);
    for (int i = 0; i < 40; ++i) {
      const Vec3 point = point_in_cube(dice, 5.0);
      expect_brute_force(tree, surface, point, 2.0 * dice.roll());
    }
  }
}

TEST(BoxTree, OfSeveralNearestTheLowestNumber) {
  const Surface surface = test::sphere(4, 0.2).surface;
  const BoxTree tree(surface);
  const geometry::Neighbours neighbours(surface);
  // Beyond a vertex all triangles at it are equally near.
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Near nearest = tree.nearest(1.5 * surface.vertices[v]);
    EXPECT_EQ(nearest.triangle, neighbours.triangles_at(static_cast<int>(v)).front());
    EXPECT_EQ(nearest.weights.maxCoeff(), 1.0);
  }
}

// Every triangle by the solution of point + x direction = a + y (b - a) + z (c - a).
TEST(BoxTree, FindsTheFirstTriangleAlongAWay) {
  int met = 0;
  int passed = 0;
  for (const Surface& surface :
       {test::torus(0.4, 3.0, {.seed = 3}).surface, test::saddle(0.2).surface}) {
    const BoxTree tree(surface);
    Dice dice(7);
    for (int i = 0; i < 200; ++i) {
      const Vec3 point = point_in_cube(dice, 3.0);
      const Vec3 direction = point_in_cube(dice, 1.0).normalized();
      const double least = dice.roll();
      double first = std::numeric_limits<double>::infinity();
      for (const auto& [a, b, c] : surface.triangles) {
        const Vec3& from = surface.vertices[static_cast<std::size_t>(a)];
        Eigen::Matrix3d sides;
        sides << -direction, surface.vertices[static_cast<std::size_t>(b)] - from,
            surface.vertices[static_cast<std::size_t>(c)] - from;
        const Vec3 x = sides.partialPivLu().solve(point - from);
        if (x[1] >= 0.0 && x[2] >= 0.0 && x[1] + x[2] <= 1.0 && x[0] > least)
          first = std::min(first, x[0]);
      }
      const double found = tree.first_along(point, direction, least);
      if (std::isinf(first)) {
        EXPECT_EQ(found, first);
        ++passed;
      } else {
        EXPECT_NEAR(found, first, 1e-10);
        ++met;
      }
    }
  }
  EXPECT_GT(met, 30);
  EXPECT_GT(passed, 30);
  // Straight from a face of a box to the other, along an axis.
  const Surface box =
      geometry::sampled(geometry::Cuboid{{2.0, 3.0, 4.0}}, {5.0, 5.0}).parts[0].surface;
  EXPECT_DOUBLE_EQ(BoxTree(box).first_along({0.5, 0.7, 4.0}, -Vec3::UnitZ(), 1e-6), 4.0);
}

TEST(BoxTree, ServesOneTriangle) {
  const Surface surface{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const BoxTree tree(surface);
  EXPECT_EQ(tree.nearest({5, 5, 5}).triangle, 0);
  std::vector<Near> found;
  tree.within({0.2, 0.2, 1.0}, 1.0, found);  // at the very radius it counts
  EXPECT_EQ(found.size(), 1U);
  tree.within({0.2, 0.2, 1.0}, 0.999, found);
  EXPECT_TRUE(found.empty());
}

TEST(NearestWeights, OfASliverStayWithinIt) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    Dice dice(seed);
    const Vec3 a = point_in_cube(dice, 1.0);
    const Vec3 b = point_in_cube(dice, 1.0);
    const Vec3 c = a + dice.roll() * (b - a) + 1e-6 * point_in_cube(dice, 1.0);
    const Vec3 point = point_in_cube(dice, 2.0);
    const Vec3 weights = geometry::nearest_weights(point, a, b, c);
    RC_ASSERT(weights.minCoeff() >= -1e-9);  // v and w round on a height of 1e-6
    RC_ASSERT(std::abs(weights.sum() - 1.0) <= 1e-12);
    const double got = (weights[0] * a + weights[1] * b + weights[2] * c - point).norm();
    RC_ASSERT(std::abs(got - std::sqrt(distance_squared(point, a, b, c))) <= 1e-5);
  }));
}

}  // namespace
}  // namespace palpate
