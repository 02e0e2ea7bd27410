// Graded boxes: the law of their cells' sizes, families, mirror images, and 1 as no grading at all.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"

namespace palpate::meshing {
namespace {

using Cells = std::array<int, 3>;

// The places of the cells' ends along an axis, from 0.
std::vector<double> ends(const geometry::TetMesh& mesh, Eigen::Index axis) {
  std::set<double> places;
  for (const Vec3& node : mesh.nodes) places.insert(node[axis]);
  return {places.begin(), places.end()};
}

Cells some_cells() {
  return {*rc::gen::inRange(1, 9), *rc::gen::inRange(1, 9), *rc::gen::inRange(1, 9)};
}

Vec3 some_place(const Vec3& size) {
  Vec3 place;
  for (Eigen::Index axis = 0; axis < 3; ++axis) place[axis] = 0.1 * *rc::gen::inRange(-1, 12);
  return place.cwiseProduct(size);
}

TEST(Graded, one_is_the_old_box_to_the_bit) {
  EXPECT_TRUE(rc::check([] {
    const Cells cells = some_cells();
    const Vec3 size(0.06, 0.05, 0.03);
    for (const auto pattern : {geometry::CellPattern::kuhn, geometry::CellPattern::mirrored}) {
      const geometry::TetMesh plain = geometry::cuboid(size, cells, pattern);
      const geometry::TetMesh graded =
          geometry::cuboid(size, cells, pattern, {1.0, some_place(size)});
      RC_ASSERT(graded.nodes == plain.nodes);
      RC_ASSERT(graded.tetrahedra == plain.tetrahedra);
      for (int i = 0; i <= cells[0]; ++i)
        RC_ASSERT(plain.nodes[static_cast<std::size_t>(i)].x() ==
                  0.06 * (static_cast<double>(i) / cells[0]));
    }
  }));
}

TEST(Graded, fills_the_box_with_as_many_sound_cells_wherever_the_finest_are) {
  EXPECT_TRUE(rc::check([] {
    const Cells cells = some_cells();
    const Vec3 size = *rc::gen::element(1e-3, 1.0, 1e3) * Vec3(1.0, 1.7, 0.6);
    const geometry::Grading grading{*rc::gen::element(1.0 + 1e-9, 1.5, 12.0, 300.0),
                                    some_place(size)};
    const auto pattern =
        *rc::gen::element(geometry::CellPattern::kuhn, geometry::CellPattern::mirrored);
    const geometry::TetMesh mesh = geometry::cuboid(size, cells, pattern, grading);
    RC_ASSERT(mesh.tetrahedra == geometry::cuboid(size, cells, pattern).tetrahedra);
    check(mesh, "box", size.prod());
    RC_ASSERT(std::abs(geometry::volume(mesh) - size.prod()) <
              1e-12 * size.prod());  // rounding of the sum
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      RC_ASSERT(geometry::signed_volume(mesh, static_cast<int>(t)) > 0.0);
    RC_ASSERT(mesh.nodes.front() == Vec3(Vec3::Zero()));
    RC_ASSERT(mesh.nodes.back() == size);
  }));
}

// x = core sinh(i theta) from the finest place, with the same core along every axis: the farthest
// cell's size over the nearest is sqrt(1 + (d / core)^2) at the farthest end of all.
TEST(Graded, cells_end_where_the_hyperbolic_sine_says) {
  const Vec3 size(0.060, 0.060, 0.010);
  const double ratio = 12.0;
  const geometry::TetMesh mesh = geometry::cuboid(
      size, {10, 12, 6}, geometry::CellPattern::mirrored, {ratio, Vec3(0.030, 0.030, 0.010)});
  const double core = 0.030 / std::sqrt(ratio * ratio - 1.0);
  const auto expect_axis = [&](Eigen::Index axis, double finest, double length, int count) {
    const double theta = std::asinh(length / core) / count;
    const std::vector<double> found = ends(mesh, axis);
    for (int i = 0; i <= count; ++i) {
      const double d = core * std::sinh(i * theta);
      const auto nearest = [&](double place) {
        double least = size[axis];
        for (const double x : found) least = std::min(least, std::abs(x - place));
        return least;
      };
      EXPECT_LT(nearest(finest - d), 1e-14 * 0.06 * 100) << axis << " " << i;  // rounding of q^i
      if (finest < size[axis]) {
        EXPECT_LT(nearest(finest + d), 1e-14 * 0.06 * 100) << axis << " " << i;
      }
    }
  };
  expect_axis(0, 0.030, 0.030, 5);
  expect_axis(1, 0.030, 0.030, 6);
  expect_axis(2, 0.010, 0.010, 6);
}

// Tissue that changes at a height changes between cells.
TEST(Graded, cells_end_at_every_level) {
  const std::vector<double> levels{0.002, 0.017, 0.018};
  for (const double ratio : {1.0, 8.0}) {
    const geometry::TetMesh mesh =
        geometry::cuboid({0.060, 0.060, 0.020}, {2, 2, 6}, geometry::CellPattern::mirrored,
                         {ratio, Vec3(0.030, 0.030, 0.020)}, levels);
    const std::vector<double> z = ends(mesh, 2);
    EXPECT_EQ(z.size(), 7U);
    EXPECT_EQ(z.front(), 0.0);
    EXPECT_EQ(z.back(), 0.020);
    for (const double level : levels) EXPECT_EQ(std::count(z.begin(), z.end(), level), 1) << level;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      EXPECT_GT(geometry::signed_volume(mesh, static_cast<int>(t)), 0.0);
  }
  try {
    (void)geometry::cuboid({0.060, 0.060, 0.020}, {2, 2, 3}, geometry::CellPattern::kuhn, {},
                           levels);
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(),
                 "a box of 3 cells in height cannot have cell borders at 3 given heights; ask for "
                 "more cells");
  }
}

TEST(Graded, sizes_grow_away_from_the_finest_place_and_two_sides_share_the_cells) {
  const geometry::TetMesh mesh =
      geometry::cuboid({0.060, 0.060, 0.030}, {12, 12, 8}, geometry::CellPattern::kuhn,
                       {10.0, Vec3(0.010, 0.030, 0.030)});
  const std::vector<double> x = ends(mesh, 0);
  const auto at = std::find(x.begin(), x.end(), 0.010) - x.begin();
  ASSERT_LT(at, 13);  // the finest place is where two cells meet
  // asinh(0.010 / core) : asinh(0.050 / core) with core = 0.050 / sqrt(99) is 1.443 : 2.993, so
  // that 3.9 of the 12 cells lie on the short side.
  EXPECT_EQ(at, 4);
  const auto size_of = [&](std::size_t i) { return x[i + 1] - x[i]; };
  for (std::size_t i = 4; i + 2 < x.size(); ++i) EXPECT_LT(size_of(i), size_of(i + 1));
  for (std::size_t i = 0; i + 2 < 5; ++i) EXPECT_GT(size_of(i), size_of(i + 1));
  const std::vector<double> z = ends(mesh, 2);
  for (std::size_t i = 0; i + 2 < z.size(); ++i) EXPECT_GT(z[i + 1] - z[i], z[i + 2] - z[i + 1]);
  const double theta = std::asinh(0.030 / (0.050 / std::sqrt(99.0))) / 8.0;
  EXPECT_NEAR((z[1] - z[0]) / (z[8] - z[7]),
              (std::sinh(8.0 * theta) - std::sinh(7.0 * theta)) / std::sinh(theta),
              1e-11);  // rounding of differences of places
}

TEST(Graded, twice_as_many_cells_halve_each_of_a_family) {
  const Vec3 size(0.06, 0.06, 0.03);
  const geometry::Grading grading{8.0, Vec3(0.03, 0.03, 0.03)};
  const geometry::TetMesh coarse =
      geometry::cuboid(size, {6, 8, 5}, geometry::CellPattern::mirrored, grading);
  const geometry::TetMesh fine =
      geometry::cuboid(size, {12, 16, 10}, geometry::CellPattern::mirrored, grading);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::vector<double> few = ends(coarse, axis);
    const std::vector<double> many = ends(fine, axis);
    for (std::size_t i = 0; i < few.size(); ++i)
      EXPECT_NEAR(few[i], many[2 * i], 1e-13 * 0.06 * 10);  // rounding of powers up to q^8
  }
}

TEST(Graded, a_box_graded_about_its_middle_is_its_own_mirror_image) {
  const Vec3 size(0.06, 0.04, 0.03);
  const Cells cells{6, 8, 4};
  const geometry::TetMesh mesh =
      geometry::cuboid(size, cells, geometry::CellPattern::mirrored, {9.0, Vec3(0.03, 0.02, 0.03)});
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const std::vector<double> places = ends(mesh, axis);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(places[i] + places[places.size() - 1 - i], size[axis], 1e-17);  // one rounding
  }
}

// A side that is too short for a cell of its own must not get a sliver.
TEST(Graded, a_finest_place_beside_an_end_moves_onto_it) {
  const geometry::TetMesh mesh =
      geometry::cuboid({0.06, 0.06, 0.03}, {4, 4, 4}, geometry::CellPattern::kuhn,
                       {5.0, Vec3(1e-9, 0.03, 0.03 - 1e-12)});
  EXPECT_GT(ends(mesh, 0)[1], 0.003);
  EXPECT_LT(ends(mesh, 2)[3], 0.03 - 0.0015);
  EXPECT_EQ(ends(mesh, 0).size(), 5u);
}

}  // namespace
}  // namespace palpate::meshing
