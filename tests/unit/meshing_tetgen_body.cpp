// Bodies in tetrahedra: near the target, every region where it belongs, inclusions refused by name.
#include "meshing/tetgen_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"
#include "tetgen_calls.h"

namespace palpate::meshing {
namespace {

using test::mesh_complaint;
using test::time_given;

constexpr double degrees = std::numbers::pi / 180.0;

const std::vector<geometry::Shape> shapes{geometry::Cuboid{},    geometry::Cylinder{},
                                          geometry::Ellipsoid{}, geometry::Ligament{},
                                          geometry::BoneShaft{}, geometry::LayeredLimb{}};

geometry::TetMesh shape_mesh(const geometry::Shape& shape, const Target& target,
                             const std::vector<geometry::Inclusion>& inclusions = {}) {
  return tetgen_shape(shape, inclusions, target, time_given);
}

std::map<int, double> volumes(const geometry::TetMesh& mesh) {
  std::map<int, double> sums;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    sums[mesh.region(static_cast<int>(t))] += geometry::signed_volume(mesh, static_cast<int>(t));
  return sums;
}

geometry::Surface moved(geometry::Surface surface, const Vec3& by) {
  for (Vec3& vertex : surface.vertices) vertex += by;
  return surface;
}

geometry::Surface box(double side, const Vec3& at, int cells) {
  return moved(geometry::box_surface(Vec3::Constant(side), {cells, cells, cells}), at);
}

TEST(TetGenBody, comes_within_three_percent_of_most_targets) {
  for (const geometry::Shape& shape : shapes)
    for (const int target : {400, 800, 3000}) {
      const geometry::TetMesh mesh = shape_mesh(shape, {.nodes = target});
      EXPECT_NEAR(static_cast<double>(mesh.nodes.size()), target, 0.03 * target) << shape.index();
      const Quality q = quality(mesh);
      EXPECT_GT(q.smallest_angle, 8.0 * degrees) << shape.index();   // measured 9.7 to 23
      EXPECT_LT(q.largest_angle, 167.0 * degrees) << shape.index();  // measured 141 to 161
    }
}

// Nodes and tetrahedra of the paper's Table 2, on bodies of human size.
TEST(TetGenBody, meets_the_papers_models) {
  struct Row {
    geometry::Shape shape;
    int nodes, tetrahedra;
  };
  const std::vector<Row> rows{{geometry::Ellipsoid{}, 456, 1470},
                              {geometry::Ligament{}, 601, 1900},
                              {geometry::LayeredLimb{}, 728, 2550}};
  for (const Row& row : rows) {
    const geometry::TetMesh mesh =
        shape_mesh(row.shape, {.nodes = row.nodes, .tetrahedra = row.tetrahedra});
    EXPECT_NEAR(static_cast<double>(mesh.nodes.size()), row.nodes, 0.03 * row.nodes);
    EXPECT_NEAR(static_cast<double>(mesh.tetrahedra.size()), row.tetrahedra, 0.03 * row.tetrahedra);
    const Quality q = quality(mesh);
    EXPECT_GT(q.smallest_angle, 8.0 * degrees);             // measured 11, 18 and 15
    EXPECT_GT(q.shortest_altitude, 0.2 * q.shortest_edge);  // measured 0.33 and more
    EXPECT_EQ(volumes(mesh).size(), row.nodes == 728 ? 3u : 1u);
  }
}

TEST(TetGenBody, an_edge_length_is_met_on_average) {
  for (const geometry::Shape& shape : shapes) {
    const double wanted = geometry::extent(shape).minCoeff() / 6.0;
    const geometry::TetMesh mesh = shape_mesh(shape, {.edge_length = wanted});
    double sum = 0.0;
    const auto all = geometry::edges(mesh);
    for (const auto& [a, b] : all)
      sum += (mesh.nodes[static_cast<std::size_t>(a)] - mesh.nodes[static_cast<std::size_t>(b)])
                 .norm();
    EXPECT_NEAR(sum / static_cast<double>(all.size()) / wanted, 1.0, 0.1)  // measured 0.95 to 0.99
        << shape.index();
  }
}

TEST(TetGenBody, the_same_question_has_the_same_answer) {
  const std::vector<geometry::Inclusion> inclusion{{{0.03, 0.04, 0.03}, 0.01, 1}};
  const geometry::TetMesh a = shape_mesh(geometry::Cylinder{}, {.nodes = 500}, inclusion);
  const geometry::TetMesh b = shape_mesh(geometry::Cylinder{}, {.nodes = 500}, inclusion);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.regions, b.regions);
}

TEST(TetGenBody, a_body_of_one_tissue_names_no_regions) {
  EXPECT_TRUE(shape_mesh(geometry::Cylinder{}, {.nodes = 300}).regions.empty());
}

TEST(TetGenBody, a_limbs_regions_fill_what_their_surfaces_enclose) {
  const geometry::Body body = geometry::sampled(geometry::LayeredLimb{}, {0.02, 0.02});
  const auto inside = [&](std::size_t p) {
    return geometry::enclosed(body.parts[p].surface).volume;
  };
  const geometry::TetMesh mesh = tetgen_body(body, {.edge_length = 0.02}, time_given);
  const auto sums = volumes(mesh);
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_NEAR(sums.at(0), inside(0) - inside(1), 1e-12 * inside(0));  // rounding, as below
  EXPECT_NEAR(sums.at(1), inside(1) - inside(2), 1e-12 * inside(0));
  EXPECT_NEAR(sums.at(2), inside(2), 1e-12 * inside(0));
}

// Also where it takes the middle of the shape.
TEST(TetGenBody, an_inclusion_has_its_own_region_in_every_shape) {
  for (const geometry::Shape& shape : shapes) {
    const Vec3 size = geometry::extent(shape);
    const bool limb = std::holds_alternative<geometry::LayeredLimb>(shape);
    geometry::Inclusion inclusion{0.5 * size, 0.3 * size.minCoeff(), 7};
    if (limb) inclusion = {{0.130, 0.175, 0.090}, 0.015, 7};  // in the muscle
    const geometry::TetMesh mesh = shape_mesh(shape, {.nodes = 1200}, {inclusion});
    const auto sums = volumes(mesh);
    ASSERT_EQ(sums.size(), limb ? 4u : 2u);
    const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(inclusion.radius, 3);
    EXPECT_NEAR(sums.at(7) / ball, 1.0, 1e-6) << shape.index();
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      for (const int node : mesh.tetrahedra[t]) {
        const double from = (mesh.nodes[static_cast<std::size_t>(node)] - inclusion.centre).norm() /
                            inclusion.radius;
        if (mesh.region(static_cast<int>(t)) == 7) {
          EXPECT_LT(from, 1.1);  // vertices lie outside so that the volume is the ball's
        }
      }
  }
}

TEST(TetGenBody, inclusions_may_lie_in_each_other) {
  const Vec3 middle(0.03, 0.04, 0.03);
  const geometry::TetMesh mesh =
      shape_mesh(geometry::Cylinder{}, {.nodes = 1500}, {{middle, 0.018, 4}, {middle, 0.009, 2}});
  const auto sums = volumes(mesh);
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_NEAR(sums.at(2) / sums.at(4), 1.0 / 7.0, 1e-6);
}

TEST(TetGenBody, refuses_inclusions_that_are_not_wholly_inside) {
  const auto refusal = [](const geometry::Shape& shape,
                          const std::vector<geometry::Inclusion>& inclusions) {
    return mesh_complaint([&] { (void)shape_mesh(shape, {.nodes = 800}, inclusions); });
  };
  EXPECT_EQ(
      refusal(geometry::Cylinder{}, {{{0.03, 0.04, 0.05}, 0.012, 1}}),
      "the inclusion of radius 12 mm about (30, 40, 50) mm does not lie wholly inside the body; "
      "move it inwards or make it smaller");
  EXPECT_TRUE(
      refusal(geometry::Cylinder{}, {{{0.03, 0.04, 0.20}, 0.012, 1}})
          .starts_with("the inclusion of radius 12 mm about (30, 40, 200) mm does not lie "));
  EXPECT_TRUE(
      refusal(geometry::Cylinder{}, {{{0.03, 0.04, 0.03}, 0.5, 1}})
          .starts_with("the inclusion of radius 500 mm about (30, 40, 30) mm does not lie "));
  EXPECT_EQ(
      refusal(geometry::LayeredLimb{}, {{{0.158, 0.175, 0.090}, 0.005, 3}}),
      "the inclusion of radius 5 mm about (158, 175, 90) mm touches the boundary of region 1; "
      "move it away from there or make it smaller");
  EXPECT_TRUE(refusal(geometry::Cylinder{},
                      {{{0.03, 0.03, 0.03}, 0.008, 1}, {{0.03, 0.04, 0.03}, 0.008, 2}})
                  .find("touches the boundary of region 1") != std::string::npos);
}

TEST(TetGenBody, surfaces_of_a_user_may_nest) {
  const geometry::Body body{{{box(0.06, Vec3::Zero(), 6), 0},
                             {box(0.03, {0.015, 0.015, 0.015}, 4), 5},
                             {box(0.01, {0.02, 0.02, 0.02}, 2), 9}}};
  const auto sums = volumes(tetgen_body(body, {.nodes = 900}, time_given));
  ASSERT_EQ(sums.size(), 3u);
  EXPECT_NEAR(sums.at(0), 0.06 * 0.06 * 0.06 - 27e-6, 1e-16);  // rounding, as below
  EXPECT_NEAR(sums.at(5), 26e-6, 1e-16);
  EXPECT_NEAR(sums.at(9), 1e-6, 1e-16);
}

TEST(TetGenBody, parts_may_share_a_face) {
  const geometry::Body body{
      {{geometry::box_surface({0.02, 0.01, 0.01}, {4, 2, 2}), 0}, {box(0.01, Vec3::Zero(), 2), 3}}};
  const auto sums = volumes(tetgen_body(body, {.nodes = 120}, time_given));
  EXPECT_NEAR(sums.at(0), 1e-6, 1e-18);  // rounding
  EXPECT_NEAR(sums.at(3), 1e-6, 1e-18);
}

TEST(TetGenBody, keeps_the_triangles_of_a_fine_surface) {
  const geometry::Body body = geometry::sampled(geometry::Cylinder{}, {0.01, 0.01});
  const geometry::Surface& surface = body.parts.front().surface;
  const geometry::TetMesh mesh = tetgen_body(body, {.nodes = 700}, time_given);
  EXPECT_NEAR(static_cast<double>(mesh.nodes.size()), 700, 0.03 * 700);
  const geometry::OuterSurface outside = geometry::outer_surface(mesh);
  EXPECT_EQ(outside.surface.vertices.size(), surface.vertices.size());
  std::set<std::array<double, 3>> places;
  for (const Vec3& v : surface.vertices) places.insert({v.x(), v.y(), v.z()});
  for (const Vec3& v : outside.surface.vertices) EXPECT_TRUE(places.count({v.x(), v.y(), v.z()}));
}

// Twelve triangles leave no room for nodes unless they may be split.
TEST(TetGenBody, splits_the_triangles_of_a_coarse_surface) {
  const geometry::Body body{{{geometry::box_surface({0.06, 0.06, 0.03}, {1, 1, 1}), 0}}};
  const geometry::TetMesh by_nodes = tetgen_body(body, {.nodes = 700}, time_given);
  EXPECT_NEAR(static_cast<double>(by_nodes.nodes.size()), 700, 0.25 * 700);  // the refusal's bound
  EXPECT_GT(tetgen_body(body, {.edge_length = 0.01}, time_given).nodes.size(), 300u);
}

TEST(TetGenBody, refuses_what_cannot_be_met) {
  const geometry::Body cylinder = geometry::sampled(geometry::Cylinder{}, {0.01, 0.01});
  EXPECT_EQ(mesh_complaint([&] { (void)tetgen_body(cylinder, {.nodes = 100}, time_given); }),
            "no mesh near 100 nodes was found, as the surfaces alone have " +
                std::to_string(cylinder.parts.front().surface.vertices.size()) +
                "; ask for about as many, or change the surface");
  const std::string message = mesh_complaint(
      [] { (void)shape_mesh(geometry::Ellipsoid{}, {.nodes = 500, .tetrahedra = 500}); });
  EXPECT_TRUE(message.starts_with("no mesh near 500 nodes and 500 tetrahedra was found, the "))
      << message;
  EXPECT_TRUE(mesh_complaint([&] {
                (void)tetgen_body(cylinder, {.nodes = 5000}, 1e-9);
              }).ends_with("within 1e-09 s; ask for fewer nodes or allow more time"));
}

TEST(TetGenBody, refuses_surfaces_that_are_inside_out_or_outside) {
  geometry::Surface turned = box(0.01, Vec3::Zero(), 2);
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(mesh_complaint([&] {
              (void)tetgen_body({{{turned, 0}}}, {.nodes = 50}, time_given);
            }),
            "a surface of the body is inside out; turn its triangles round");
  const geometry::Body apart{{{box(0.01, Vec3::Zero(), 2), 0}, {box(0.01, {0.02, 0, 0}, 2), 1}}};
  EXPECT_EQ(mesh_complaint([&] { (void)tetgen_body(apart, {.nodes = 80}, time_given); }),
            "a part of the body lies outside its outer surface; move it inwards");
}

}  // namespace
}  // namespace palpate::meshing
