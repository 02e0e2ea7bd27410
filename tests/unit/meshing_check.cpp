// Every way a mesh can be unfit, and the sentence for it; at the size of a cell and of a house.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"
#include "refusal.h"

namespace palpate::meshing {
namespace {

// Node 0 in the origin, nodes 1 to 3 on the axes.
geometry::TetMesh corner_tetrahedron(double scale) {
  return {{{0, 0, 0}, {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}, {{0, 1, 2, 3}}};
}

std::string complaint(const geometry::TetMesh& mesh, double expected_volume = 0.0) {
  return test::refusal<MeshError>([&] { check(mesh, "paw", expected_volume); }, "sound");
}

class CheckAtScale : public testing::TestWithParam<double> {};

TEST_P(CheckAtScale, accepts_what_is_sound) {
  const double scale = GetParam();
  EXPECT_EQ(complaint(corner_tetrahedron(scale)), "sound");
  EXPECT_EQ(complaint(corner_tetrahedron(scale), scale * scale * scale / 6.0), "sound");
  EXPECT_EQ(complaint(geometry::cuboid({scale, scale, scale}, {2, 3, 4},
                                       geometry::CellPattern::mirrored)),
            "sound");
}

TEST_P(CheckAtScale, refuses_a_flat_tetrahedron_but_not_a_thin_one) {
  const double scale = GetParam();
  geometry::TetMesh mesh = corner_tetrahedron(scale);
  mesh.nodes[3].z() = 1e-4 * scale;
  EXPECT_EQ(complaint(mesh), "sound");
  mesh.nodes[3].z() = 1e-12 * scale;
  EXPECT_TRUE(complaint(mesh).starts_with("mesh `paw`: tetrahedron 0 (0, 1, 2, 3) is flat"))
      << complaint(mesh);
}

TEST_P(CheckAtScale, refuses_a_wrong_sum_of_volumes) {
  const double scale = GetParam();
  const geometry::TetMesh mesh =
      geometry::cuboid({scale, scale, scale}, {2, 2, 2}, geometry::CellPattern::kuhn);
  const double cube = scale * scale * scale;
  EXPECT_EQ(complaint(mesh, cube * (1 + 0.9e-6)), "sound");
  EXPECT_TRUE(complaint(mesh, cube * (1 + 1.1e-6)).starts_with("mesh `paw`: the tetrahedra fill "));
}

INSTANTIATE_TEST_SUITE_P(Sizes, CheckAtScale, testing::Values(1e-6, 1e-3, 1.0, 1e4));

TEST(Check, names_the_volumes) {
  EXPECT_EQ(complaint(geometry::cuboid({1, 1, 1}, {1, 1, 1}, geometry::CellPattern::kuhn), 2.0),
            "mesh `paw`: the tetrahedra fill 1 m^3, but the body has 2 m^3; look for overlaps and "
            "holes, or for a wrong unit");
}

TEST(Check, refuses_no_tetrahedra) {
  EXPECT_EQ(complaint({}),
            "mesh `paw`: has no tetrahedra; check that the surface it was made from is closed");
}

TEST(Check, refuses_an_index_out_of_range) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.tetrahedra[0][3] = 4;
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: tetrahedron 0 names node 4, but the nodes run from 0 to 3; check whether "
            "the numbering starts from 0 or 1");
  mesh.tetrahedra[0][3] = -1;
  EXPECT_TRUE(complaint(mesh).starts_with("mesh `paw`: tetrahedron 0 names node -1, "));
}

TEST(Check, refuses_a_coordinate_that_is_not_finite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    geometry::TetMesh mesh = corner_tetrahedron(1.0);
    mesh.nodes[2].y() = bad;
    EXPECT_EQ(complaint(mesh),
              "mesh `paw`: node 2 has a coordinate that is not a finite number; write the mesh "
              "again from its source");
  }
}

TEST(Check, refuses_a_repeated_node) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.tetrahedra[0] = {0, 1, 2, 1};
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: tetrahedron 0 (0, 1, 2, 1) has node 1 twice; remove it or mesh the body "
            "again");
}

TEST(Check, refuses_an_inside_out_tetrahedron) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.tetrahedra[0] = {0, 2, 1, 3};
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: tetrahedron 0 (0, 2, 1, 3) is inside out (volume -0.1667 m^3); swap two "
            "of its nodes");
}

TEST(Check, refuses_an_unused_node) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.nodes.emplace_back(2, 2, 2);
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: node 4 belongs to no tetrahedron; remove it and renumber the nodes");
}

TEST(Check, refuses_a_face_of_three_tetrahedra) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.nodes.emplace_back(0.1, 0.1, -1);
  mesh.nodes.emplace_back(0.2, 0.2, -1);
  mesh.tetrahedra.push_back({0, 2, 1, 4});
  EXPECT_EQ(complaint({{mesh.nodes.begin(), mesh.nodes.end() - 1}, mesh.tetrahedra}), "sound");
  mesh.tetrahedra.push_back({0, 2, 1, 5});
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: face (0, 1, 2) belongs to more than two tetrahedra (0, 1, 2); remove the "
            "ones that overlap");
}

TEST(Check, refuses_two_tetrahedra_on_one_side_of_a_face) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.nodes.emplace_back(0.2, 0.2, 0.5);
  mesh.tetrahedra.push_back({0, 1, 2, 4});
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: tetrahedra 0 and 1 lie on the same side of face (0, 1, 2); remove the one "
            "that overlaps");
}

TEST(Check, refuses_parts_that_touch_in_an_edge_only) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  mesh.nodes.emplace_back(0, -1, 0);
  mesh.nodes.emplace_back(0, 0, -1);
  mesh.tetrahedra.push_back({0, 1, 4, 5});
  ASSERT_GT(geometry::signed_volume(mesh, 1), 0.0);
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: parts of its boundary touch at node 1; join the parts that only touch "
            "there, or separate them");
}

TEST(Check, refuses_parts_that_touch_in_a_node_only) {
  geometry::TetMesh mesh = corner_tetrahedron(1.0);
  for (const Vec3& node : {Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)})
    mesh.nodes.push_back(node);
  mesh.tetrahedra.push_back({0, 4, 6, 5});
  ASSERT_GT(geometry::signed_volume(mesh, 1), 0.0);
  EXPECT_EQ(complaint(mesh),
            "mesh `paw`: parts of its boundary touch at node 0; join the parts that only touch "
            "there, or separate them");
}

// A tetrahedron taken out of the middle of a box leaves it closed, so only the sum can tell.
TEST(Check, finds_a_hole_by_the_sum) {
  geometry::TetMesh mesh = geometry::cuboid({1, 1, 1}, {3, 3, 3}, geometry::CellPattern::kuhn);
  mesh.tetrahedra.erase(mesh.tetrahedra.begin() + 6 * 13);
  EXPECT_TRUE(complaint(mesh, 1.0).starts_with("mesh `paw`: "));
}

}  // namespace
}  // namespace palpate::meshing
