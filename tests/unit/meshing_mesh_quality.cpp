// Measures of shape on tetrahedra whose angles and altitudes are known.
#include "meshing/mesh_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/cuboid.h"

namespace palpate::meshing {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

// Every second corner of a cube of side 1: edges of sqrt(2), altitude 2 / sqrt(3).
const geometry::TetMesh regular{{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}, {{0, 2, 1, 3}}};

TEST(Quality, a_regular_tetrahedron_is_perfect) {
  ASSERT_GT(geometry::signed_volume(regular, 0), 0.0);
  const Quality q = quality(regular);
  EXPECT_NEAR(q.smallest_angle, std::acos(1.0 / 3.0), 1e-15);  // rounding, as all below
  EXPECT_NEAR(q.largest_angle, std::acos(1.0 / 3.0), 1e-15);
  EXPECT_EQ(q.angles[7], 6);  // 70 to 80 degrees
  EXPECT_NEAR(q.largest_edge_ratio, 1.0, 1e-15);
  EXPECT_NEAR(q.smallest_mean_ratio, 1.0, 1e-15);
  EXPECT_NEAR(q.shortest_altitude, 2.0 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(q.smallest_volume, 1.0 / 3.0, 1e-15);
}

// A box's lattice is cut into path tetrahedra: right angles, 45 and 60 degrees in a cube.
TEST(Quality, path_tetrahedra_of_a_cube) {
  const geometry::TetMesh mesh =
      geometry::cuboid({0.02, 0.02, 0.02}, {2, 2, 2}, geometry::CellPattern::kuhn);
  const Quality q = quality(mesh);
  EXPECT_NEAR(q.smallest_angle, 45.0 * degree, 1e-15);
  EXPECT_NEAR(q.largest_angle, 90.0 * degree, 1e-15);
  EXPECT_NEAR(q.largest_edge_ratio, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(q.shortest_edge, 0.01, 1e-17);
  EXPECT_NEAR(q.longest_edge, 0.01 * std::sqrt(3.0), 1e-17);
  EXPECT_NEAR(q.shortest_altitude, 0.01 / std::sqrt(2.0), 1e-17);
  EXPECT_NEAR(q.smallest_volume, 1e-6 / 6.0, 1e-21);
  EXPECT_EQ(q.limiting_tetrahedron, 0);
  EXPECT_EQ(std::accumulate(q.angles.begin(), q.angles.end(), 0),
            6 * static_cast<int>(mesh.tetrahedra.size()));
}

TEST(Quality, names_the_tetrahedron_with_the_shortest_altitude) {
  // A fifth node on the way from the middle to node 3 cuts it into four.
  geometry::TetMesh one = regular;
  one.nodes.push_back(0.25 * (one.nodes[0] + one.nodes[1] + one.nodes[2] + one.nodes[3]));
  one.nodes.back() += 0.2 * (one.nodes[3] - one.nodes.back());
  one.tetrahedra = {{0, 2, 1, 4}, {2, 3, 1, 4}, {0, 3, 2, 4}, {0, 1, 3, 4}};
  for (int t = 0; t < 4; ++t) ASSERT_GT(geometry::signed_volume(one, t), 0.0);
  const Quality q = quality(one);
  // The three that meet in node 3 are alike and thinner than the first.
  EXPECT_NE(q.limiting_tetrahedron, 0);
  EXPECT_LT(q.smallest_volume, q.largest_volume);
  EXPECT_NEAR(q.smallest_volume * 3.0 + q.largest_volume, 1.0 / 3.0, 1e-15);
}

TEST(Quality, a_flat_tetrahedron_has_angles_near_0_and_180) {
  const double high = 1e-3;
  const geometry::TetMesh sliver{{{0, 0, 0}, {1, 1, 0}, {1, 0, high}, {0, 1, high}},
                                 {{0, 2, 1, 3}}};
  const Quality q = quality(sliver);
  EXPECT_NEAR(q.smallest_angle, 0.0, 3e-3);  // 2 sqrt(2) high over 1
  EXPECT_NEAR(q.largest_angle, std::numbers::pi, 3e-3 * 2.0);
  EXPECT_EQ(q.angles.front() + q.angles.back(), 6);
  EXPECT_NEAR(q.shortest_altitude, 2.0 * high, 1e-3 * high);  // faces all but parallel to z = 0
  EXPECT_LT(q.smallest_mean_ratio, 0.05);
}

// Angles and ratios have no unit; lengths follow the body.
TEST(Quality, follows_the_size) {
  geometry::TetMesh mesh = geometry::cuboid({1, 2, 3}, {2, 3, 1}, geometry::CellPattern::mirrored);
  const Quality one = quality(mesh);
  for (Vec3& node : mesh.nodes) node *= 0.5;
  const Quality half = quality(mesh);
  EXPECT_EQ(half.angles, one.angles);  // a power of two changes no digit
  EXPECT_EQ(half.smallest_angle, one.smallest_angle);
  EXPECT_EQ(half.shortest_altitude, 0.5 * one.shortest_altitude);
  EXPECT_EQ(half.largest_volume, 0.125 * one.largest_volume);
  EXPECT_EQ(half.limiting_tetrahedron, one.limiting_tetrahedron);
}

}  // namespace
}  // namespace palpate::meshing
