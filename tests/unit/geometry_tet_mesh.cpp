// What follows from a mesh alone, on one tetrahedron and on two by hand.
#include "geometry/tet_mesh.h"

#include <gtest/gtest.h>

namespace palpate::geometry {
namespace {

const TetMesh two_given{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}},
                        {{0, 1, 2, 3}, {0, 2, 1, 4}}};

TEST(TetMesh, volumes_have_a_sign_and_a_sum) {
  EXPECT_DOUBLE_EQ(signed_volume(two_given, 0), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(signed_volume(two_given, 1), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(volume(two_given), 0.5);
  TetMesh turned = two_given;
  turned.tetrahedra[0] = {0, 1, 3, 2};
  EXPECT_DOUBLE_EQ(signed_volume(turned, 0), -1.0 / 6.0);
}

TEST(TetMesh, edges_are_sorted_and_single) {
  const std::vector<std::array<int, 2>> expected{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2},
                                                 {1, 3}, {1, 4}, {2, 3}, {2, 4}};
  EXPECT_EQ(edges(two_given), expected);
}

TEST(TetMesh, boundary_faces_come_in_the_order_of_the_tetrahedra) {
  const std::vector<std::array<int, 3>> expected{{1, 2, 3}, {0, 3, 2}, {0, 1, 3},
                                                 {2, 1, 4}, {0, 4, 1}, {0, 2, 4}};
  EXPECT_EQ(boundary_faces(two_given), expected);
}

// Gauss: the volume is the sum over the outward faces of a . (b x c) / 6.
TEST(TetMesh, boundary_faces_point_outwards) {
  double sum = 0.0;
  for (const auto& [i, j, k] : boundary_faces(two_given)) {
    const Vec3& a = two_given.nodes[static_cast<std::size_t>(i)];
    const Vec3& b = two_given.nodes[static_cast<std::size_t>(j)];
    const Vec3& c = two_given.nodes[static_cast<std::size_t>(k)];
    sum += a.dot(b.cross(c)) / 6.0;
  }
  EXPECT_DOUBLE_EQ(sum, volume(two_given));
}

TEST(TetMesh, nodes_at_height_allow_a_rounding_of_the_box) {
  TetMesh mesh = two_given;
  EXPECT_EQ(nodes_at_height(mesh, 0.0), (std::vector<int>{0, 1, 2}));
  mesh.nodes[1].z() = 1e-9;  // the diagonal is 3.3
  EXPECT_EQ(nodes_at_height(mesh, 0.0), (std::vector<int>{0, 1, 2}));
  mesh.nodes[1].z() = 1e-8;
  EXPECT_EQ(nodes_at_height(mesh, 0.0), (std::vector<int>{0, 2}));
}

TEST(TetMesh, nothing_comes_of_nothing) {
  EXPECT_EQ(volume({}), 0.0);
  EXPECT_EQ(diagonal({}), 0.0);
  EXPECT_TRUE(boundary_faces({}).empty());
}

}  // namespace
}  // namespace palpate::geometry
