// The regular box: the paper's counts, exact sums, a closed boundary, mirror symmetry.
#include "geometry/cuboid.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "meshing/mesh_check.h"

namespace palpate::meshing {
namespace {

std::size_t surface_node_count(const geometry::TetMesh& mesh) {
  std::set<int> nodes;
  for (const auto& face : geometry::boundary_faces(mesh)) nodes.insert(face.begin(), face.end());
  return nodes.size();
}

// Every tetrahedron as its sorted nodes, sorted: equal for the same cut into the same nodes.
std::vector<std::array<int, 4>> as_set(const geometry::TetMesh& mesh) {
  auto tetrahedra = mesh.tetrahedra;
  for (auto& corner : tetrahedra) std::sort(corner.begin(), corner.end());
  std::sort(tetrahedra.begin(), tetrahedra.end());
  return tetrahedra;
}

// The mesh with node (i, j, k) renamed to its mirror image across the middle of `axis`.
geometry::TetMesh reflected(const geometry::TetMesh& mesh, const std::array<int, 3>& cells,
                            std::size_t axis) {
  geometry::TetMesh image = mesh;
  for (auto& corner : image.tetrahedra)
    for (int& node : corner) {
      std::array<int, 3> at{node % (cells[0] + 1), node / (cells[0] + 1) % (cells[1] + 1),
                            node / (cells[0] + 1) / (cells[1] + 1)};
      at[axis] = cells[axis] - at[axis];
      node = at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
    }
  return image;
}

TEST(Cuboid, has_the_papers_counts) {
  const geometry::TetMesh mesh =
      geometry::cuboid({0.015, 0.020, 0.030}, {3, 4, 6}, geometry::CellPattern::kuhn);
  EXPECT_EQ(mesh.nodes.size(), 140u);                      // mesh-01
  EXPECT_EQ(mesh.tetrahedra.size(), 432u);                 // mesh-02
  EXPECT_EQ(surface_node_count(mesh), 110u);               // mesh-03
  EXPECT_EQ(geometry::boundary_faces(mesh).size(), 216u);  // mesh-04
  EXPECT_EQ(geometry::edges(mesh).size(), 679u);  // Euler: V - E + F - T = 1, F = (4 T + 216) / 2
}

// mesh-06 and mesh-07 say that 2 V - 4 triangles close a surface of genus 0 over V nodes: 176 for
// 90 and 636 for 320. The same holds for every box of ours.
TEST(Cuboid, surface_is_a_closed_sphere_of_2V_minus_4_triangles) {
  EXPECT_TRUE(rc::check([] {
    const std::array<int, 3> cells{*rc::gen::inRange(1, 6), *rc::gen::inRange(1, 6),
                                   *rc::gen::inRange(1, 6)};
    const auto pattern =
        *rc::gen::element(geometry::CellPattern::kuhn, geometry::CellPattern::mirrored);
    const geometry::TetMesh mesh = geometry::cuboid({0.01, 0.02, 0.005}, cells, pattern);
    RC_ASSERT(geometry::boundary_faces(mesh).size() == 2 * surface_node_count(mesh) - 4);
  }));
}

TEST(Cuboid, passes_the_check_and_fills_the_box_at_every_size) {
  EXPECT_TRUE(rc::check([] {
    const std::array<int, 3> cells{*rc::gen::inRange(1, 7), *rc::gen::inRange(1, 7),
                                   *rc::gen::inRange(1, 7)};
    const auto pattern =
        *rc::gen::element(geometry::CellPattern::kuhn, geometry::CellPattern::mirrored);
    const double scale = *rc::gen::element(1e-6, 1e-3, 1.0, 1e3);
    const Vec3 size = scale * Vec3(1.0, 1.7, 0.6);
    const geometry::TetMesh mesh = geometry::cuboid(size, cells, pattern);
    const double expected = size.prod();
    check(mesh, "box", expected);
    const double sum = geometry::volume(mesh);
    RC_ASSERT(std::abs(sum - expected) < 1e-13 * expected);  // rounding of at most 1296 terms
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      RC_ASSERT(geometry::signed_volume(mesh, static_cast<int>(t)) > 0.0);
  }));
}

TEST(Cuboid, numbers_nodes_x_fastest_and_ends_exactly_at_the_size) {
  const Vec3 size(0.1, 0.3, 0.7);
  const geometry::TetMesh mesh = geometry::cuboid(size, {3, 3, 7}, geometry::CellPattern::kuhn);
  EXPECT_EQ(mesh.nodes.front(), Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(mesh.nodes.back(), size);
  EXPECT_GT(mesh.nodes[1].x(), 0.0);
  EXPECT_GT(mesh.nodes[4].y(), 0.0);
  EXPECT_GT(mesh.nodes[16].z(), 0.0);
  EXPECT_EQ(geometry::nodes_at_height(mesh, size.z()).size(), 16u);
  EXPECT_EQ(geometry::nodes_at_height(mesh, size.z()).front(), 7 * 16);
}

TEST(Cuboid, mirrored_is_its_own_mirror_image_for_even_cells_and_kuhn_is_not) {
  const std::array<int, 3> cells{4, 2, 6};
  const geometry::TetMesh mirrored =
      geometry::cuboid({1, 1, 1}, cells, geometry::CellPattern::mirrored);
  const geometry::TetMesh kuhn = geometry::cuboid({1, 1, 1}, cells, geometry::CellPattern::kuhn);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(as_set(reflected(mirrored, cells, axis)), as_set(mirrored)) << "axis " << axis;
    EXPECT_NE(as_set(reflected(kuhn, cells, axis)), as_set(kuhn)) << "axis " << axis;
  }
}

TEST(Cuboid, patterns_agree_in_a_single_cell) {
  EXPECT_EQ(as_set(geometry::cuboid({1, 1, 1}, {1, 1, 1}, geometry::CellPattern::mirrored)),
            as_set(geometry::cuboid({1, 1, 1}, {1, 1, 1}, geometry::CellPattern::kuhn)));
}

TEST(Cuboid, refuses_more_tetrahedra_than_an_int_counts) {
  try {
    (void)geometry::cuboid({1, 1, 1}, {1000, 1000, 1000}, geometry::CellPattern::kuhn);
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(),
                 "a box of 1000 x 1000 x 1000 cells has more tetrahedra than can be numbered; ask "
                 "for fewer cells");
  }
}

}  // namespace
}  // namespace palpate::meshing
