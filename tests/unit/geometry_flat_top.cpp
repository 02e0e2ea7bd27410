// Finding points on the flat upper face: all of them, once, with the right weights.
#include "geometry/flat_top.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "geometry/cuboid.h"

namespace palpate::geometry {
namespace {

Vec3 at(const TetMesh& mesh, const FacePoint& point) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    sum += point.weights[i] * mesh.nodes[static_cast<std::size_t>(point.nodes[i])];
  return sum;
}

TEST(FlatTop, holds_the_upper_face_of_a_box) {
  const TetMesh mesh = cuboid({0.03, 0.02, 0.01}, {6, 4, 2}, CellPattern::kuhn);
  const FlatTop top(mesh, 0.01);
  EXPECT_EQ(top.triangles().size(), 48u);
  EXPECT_EQ(top.nodes(), nodes_at_height(mesh, 0.01));
  EXPECT_NEAR(top.area(), 6e-4, 1e-18);  // rounding of 48 terms
  // Right triangles of 5 mm legs: sqrt(4 (12.5 mm^2) / sqrt(3)) = 5.3728497 mm.
  EXPECT_NEAR(top.mean_spacing(), 5.3728497e-3, 1e-10);  // digits given
}

TEST(FlatTop, weights_rebuild_the_point_at_every_size) {
  EXPECT_TRUE(rc::check([] {
    const double scale = *rc::gen::element(1e-3, 1.0, 1e3);
    const std::array<int, 3> cells{*rc::gen::inRange(1, 9), *rc::gen::inRange(1, 9), 1};
    const auto pattern = *rc::gen::element(CellPattern::kuhn, CellPattern::mirrored);
    const Vec3 size = scale * Vec3(1.0, 3.0, 0.5);
    const TetMesh mesh = cuboid(size, cells, pattern);
    const FlatTop top(mesh, size.z());
    // Multiples of 1/48 fall on many nodes and edges.
    const double x = size.x() * (*rc::gen::inRange(0, 49) / 48.0);
    const double y = size.y() * (*rc::gen::inRange(0, 49) / 48.0);
    const auto point = top.locate(x, y);
    RC_ASSERT(point.has_value());
    const double sum = point->weights[0] + point->weights[1] + point->weights[2];
    RC_ASSERT(std::abs(sum - 1.0) < 1e-15);  // three roundings
    for (const double weight : point->weights) RC_ASSERT(weight >= 0.0);
    RC_ASSERT((at(mesh, *point) - Vec3(x, y, size.z())).norm() <
              1e-9 * scale);  // the edge tolerance of 1e-10
  }));
}

TEST(FlatTop, a_shared_node_belongs_to_the_first_triangle_that_has_it) {
  const TetMesh mesh = cuboid({1, 1, 1}, {4, 4, 1}, CellPattern::mirrored);
  const FlatTop top(mesh, 1.0);
  for (const int node : top.nodes()) {
    const Vec3& p = mesh.nodes[static_cast<std::size_t>(node)];
    const auto point = top.locate(p.x(), p.y());
    ASSERT_TRUE(point);
    const auto first = std::find_if(
        top.triangles().begin(), top.triangles().end(), [&](const std::array<int, 3>& triangle) {
          return std::find(triangle.begin(), triangle.end(), node) != triangle.end();
        });
    EXPECT_EQ(point->nodes, *first) << "node " << node;
  }
}

TEST(FlatTop, ends_at_its_rim) {
  const TetMesh mesh = cuboid({0.03, 0.02, 0.01}, {3, 2, 1}, CellPattern::kuhn);
  const FlatTop top(mesh, 0.01);
  EXPECT_TRUE(top.locate(0.03, 0.02));
  EXPECT_TRUE(top.locate(0.0, 0.02));
  EXPECT_TRUE(top.locate(0.03 * (1 + 1e-13), 0.01));
  EXPECT_FALSE(top.locate(0.03 * (1 + 1e-7), 0.01));
  EXPECT_FALSE(top.locate(-1e-9, 0.01));
  EXPECT_FALSE(top.locate(0.01, 1e300));
  EXPECT_FALSE(top.locate(std::nan(""), 0.01));
  EXPECT_FALSE(top.locate(0.01, std::numeric_limits<double>::infinity()));
}

TEST(FlatTop, takes_boundary_faces_that_look_up_only) {
  const TetMesh mesh = cuboid({1, 1, 1}, {2, 2, 2}, CellPattern::kuhn);
  EXPECT_THROW(FlatTop(mesh, 0.0), MeshError);  // looks down
  EXPECT_THROW(FlatTop(mesh, 0.5), MeshError);  // lies inside
  try {
    const FlatTop top(mesh, 2.0);
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_STREQ(
        error.what(),
        "the mesh has no flat face at height 2 m; check the height and the direction of z");
  }
}

// A face with a corner missing: the bins know a box, the face is not one.
TEST(FlatTop, a_point_in_a_notch_is_outside) {
  TetMesh mesh = cuboid({2, 2, 1}, {2, 2, 1}, CellPattern::kuhn);
  mesh.tetrahedra.resize(18);  // without the cell at high x and y
  const FlatTop top(mesh, 1.0);
  EXPECT_FALSE(top.locate(1.5, 1.5));
  EXPECT_TRUE(top.locate(0.5, 1.5));
  EXPECT_TRUE(top.locate(1.5, 0.5));
}

TEST(FlatTop, long_and_thin_faces_are_found_too) {
  const TetMesh mesh = cuboid({1.0, 1e-4, 0.1}, {50, 1, 1}, CellPattern::kuhn);
  const FlatTop top(mesh, 0.1);
  for (int i = 0; i <= 100; ++i) EXPECT_TRUE(top.locate(i / 100.0, 0.3e-4)) << i;
}

}  // namespace
}  // namespace palpate::geometry
