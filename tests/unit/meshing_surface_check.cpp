// Every way a surface can be unfit, and the sentence for it; at the size of a cell and of a leg.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "geometry/cuboid.h"
#include "meshing/surface_repair.h"

namespace palpate::meshing {
namespace {

// Vertex 0 in the origin, vertices 1 to 3 on the axes.
geometry::Surface corner(double scale = 0.01) {
  return {{{0, 0, 0}, {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

geometry::Surface box(double scale = 0.01, int cells = 3) {
  return geometry::outer_surface(geometry::cuboid({scale, scale, scale}, {cells, cells, cells},
                                                  geometry::CellPattern::kuhn))
      .surface;
}

void append(geometry::Surface& surface, const geometry::Surface& other, const Vec3& shift,
            double scale = 1.0) {
  const auto first = static_cast<int>(surface.vertices.size());
  for (const Vec3& vertex : other.vertices) surface.vertices.push_back(scale * vertex + shift);
  for (const auto& [a, b, c] : other.triangles)
    surface.triangles.push_back({a + first, b + first, c + first});
}

template <typename Check>
std::string complaint(const geometry::Surface& surface, const Check& check) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::string error = "sound";
  try {
    check(surface, "paw");
  } catch (const MeshError& caught) {
    error = caught.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return error;
}

std::string closed(const geometry::Surface& surface) { return complaint(surface, check_closed); }

class SurfaceAtScale : public testing::TestWithParam<double> {};

TEST_P(SurfaceAtScale, accepts_what_is_sound) {
  EXPECT_EQ(closed(corner(GetParam())), "sound");
  EXPECT_EQ(closed(box(GetParam())), "sound");
}

TEST_P(SurfaceAtScale, refuses_a_needle_but_not_a_thin_face) {
  geometry::Surface surface = corner(GetParam());
  surface.vertices[3].z() *= 1e-4;
  EXPECT_EQ(closed(surface), "sound");
  surface.vertices[3].z() *= 1e-3;
  EXPECT_NE(closed(surface).find("face 1 (0, 1, 3)"), std::string::npos) << closed(surface);
  EXPECT_NE(closed(surface).find("has no area: its height is below 1e-6 of its longest edge"),
            std::string::npos)
      << closed(surface);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SurfaceAtScale, testing::Values(1e-6, 1e-3, 1.0, 10.0));

TEST(SurfaceCheck, refuses_an_empty_one) {
  EXPECT_EQ(closed({}), "surface `paw`: has no faces; export it again");
  EXPECT_EQ(closed({corner().vertices, {}}), "surface `paw`: has no faces; export it again");
}

TEST(SurfaceCheck, refuses_an_index_out_of_range) {
  for (const int bad : {4, -1, std::numeric_limits<int>::max()}) {
    geometry::Surface surface = corner();
    surface.triangles[3][1] = bad;
    EXPECT_EQ(closed(surface), "surface `paw`: face 3 names vertex " + std::to_string(bad) +
                                   ", but the vertices run from 0 to 3; check whether the "
                                   "numbering starts from 0 or 1");
  }
}

TEST(SurfaceCheck, refuses_what_is_not_finite) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    geometry::Surface surface = corner();
    surface.vertices[2].y() = bad;
    EXPECT_EQ(closed(surface),
              "surface `paw`: vertex 2 has a coordinate that is not a finite number; export the "
              "surface again");
  }
}

// With every unit that makes a body of it.
TEST(SurfaceCheck, asks_about_the_unit) {
  const auto size = [](double factor, const std::string& unit) {
    return test::refusal<MeshError>(
        [&] { refuse_size(corner(factor).vertices, "surface `paw`", unit, "tissue.shape.unit"); });
  };
  EXPECT_EQ(size(60.0, "m"),
            "surface `paw`: is 60 m long in `m`, but wants 1e-6 m to 10 m; check its unit: in `cm` "
            "it would be 0.6 m long, in `mm` 0.06 m");
  EXPECT_EQ(size(2e-7, "um"),
            "surface `paw`: is 2e-07 m long in `um`, but wants 1e-6 m to 10 m; check its unit: in "
            "`m` it would be 0.2 m long");
  EXPECT_EQ(size(6e-8, "m"),
            "surface `paw`: is 6e-08 m long in `m`, but wants 1e-6 m to 10 m; check its unit");
  EXPECT_EQ(size(1e300, "m"),
            "surface `paw`: is 1e+300 m long in `m`, but wants 1e-6 m to 10 m; check its unit");
  EXPECT_EQ(other_units(0.0015, "cm"), "in `m` it would be 0.15 m long");
  EXPECT_EQ(other_units(0.0115, "cm"), "");  // a usual size
  EXPECT_EQ(
      test::refusal<MeshError>([] { return whole_surface(corner(60.0), "paw", {}); }).substr(0, 32),
      "surface `paw`: is 60 m long in `");
}

TEST(SurfaceCheck, refuses_a_repeated_vertex) {
  geometry::Surface surface = corner();
  surface.triangles.push_back({2, 3, 2});
  EXPECT_EQ(closed(surface),
            "surface `paw`: face 4 (2, 3, 2) near (0, 10, 0) mm has vertex 2 twice; remove it, and "
            "close the hole where it leaves one");
}

TEST(SurfaceCheck, refuses_a_face_twice) {
  for (const std::array<int, 3>& twin :
       {std::array{3, 1, 2}, std::array{2, 1, 3}}) {  // the same way round and turned
    geometry::Surface surface = corner();
    surface.triangles.push_back(twin);
    EXPECT_EQ(closed(surface),
              "surface `paw`: faces 3 and 4 have the same vertices near (10, 0, 0) mm; remove one "
              "of them");
  }
}

TEST(SurfaceCheck, refuses_a_face_on_a_line) {
  geometry::Surface surface = corner();
  surface.vertices.emplace_back(0.005, 0.005, 0);
  surface.triangles.push_back({1, 4, 2});
  EXPECT_EQ(closed(surface),
            "surface `paw`: face 4 (1, 4, 2) near (10, 0, 0) mm has no area: its height is below "
            "1e-6 of its longest edge (14.14 mm); merge its close vertices or swap its longest "
            "edge");
}

TEST(SurfaceCheck, refuses_two_vertices_in_one_place) {
  geometry::Surface surface = corner();
  surface.vertices.push_back(surface.vertices[1]);
  surface.triangles.push_back({1, 4, 2});
  EXPECT_NE(closed(surface).find("face 4 (1, 4, 2) near (10, 0, 0) mm has no area"),
            std::string::npos);
}

TEST(SurfaceCheck, refuses_a_loose_vertex) {
  geometry::Surface surface = corner();
  surface.vertices.emplace_back(0.001, 0.001, 0.001);
  EXPECT_EQ(closed(surface),
            "surface `paw`: vertex 4 belongs to no face; remove it and renumber the vertices");
}

TEST(SurfaceCheck, refuses_an_edge_of_three_faces) {
  geometry::Surface surface = corner();
  surface.vertices.emplace_back(0.01, 0.01, 0.01);
  surface.triangles.push_back({1, 2, 4});
  const std::string want =
      "surface `paw`: face 4 (1, 2, 4) near (10, 0, 0) mm is a third face at edge (1, 2), after "
      "faces 0 and 3; keep two of them, or separate the surfaces there";
  EXPECT_EQ(closed(surface), want);
}

TEST(SurfaceCheck, refuses_two_bodies_that_share_an_edge) {
  geometry::Surface surface = corner();
  surface.vertices.emplace_back(0, -0.01, 0);
  surface.vertices.emplace_back(0, 0, -0.01);
  for (const auto& [a, b, c] : corner().triangles) {
    const std::array<int, 4> number{0, 1, 4, 5};
    const auto own = [&](int v) { return number[static_cast<std::size_t>(v)]; };
    surface.triangles.push_back({own(a), own(b), own(c)});
  }
  EXPECT_EQ(closed(surface),
            "surface `paw`: face 4 (0, 4, 1) near (0, 0, 0) mm is a third face at edge (0, 1), "
            "after faces 0 and 1; keep two of them, or separate the surfaces there");
}

TEST(SurfaceCheck, refuses_a_turned_face) {
  geometry::Surface surface = corner();
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  const std::string want =
      "surface `paw`: face 3 (2, 1, 3) near (0, 10, 0) mm faces the side opposite to that of face "
      "0 across edge (1, 2); turn one of them round, so that all normals point outwards";
  EXPECT_EQ(closed(surface), want);
}

TEST(SurfaceCheck, counts_holes) {
  geometry::Surface surface = corner();
  surface.triangles.pop_back();
  EXPECT_EQ(closed(surface),
            "surface `paw`: is open: 3 edges in 1 hole belong to one face only, first edge (1, 2) "
            "of face 0 near (10, 0, 0) mm; merge vertices in one place and fill the holes");
}

TEST(SurfaceCheck, counts_two_holes) {
  geometry::Surface surface =
      box(0.01, 1);  // each side two faces: the tube of a box without lid and floor
  std::erase_if(surface.triangles, [&](const auto& t) {
    const auto z = [&](int v) { return surface.vertices[static_cast<std::size_t>(v)].z(); };
    return z(t[0]) == z(t[1]) && z(t[1]) == z(t[2]);
  });
  EXPECT_NE(closed(surface).find("is open: 8 edges in 2 holes"), std::string::npos)
      << closed(surface);
}

TEST(SurfaceCheck, refuses_two_parts) {
  geometry::Surface surface = corner();
  append(surface, corner(), {0.02, 0, 0});
  const std::string want =
      "surface `paw`: has 2 parts, and the one with face 4 near (20, 0, 0) mm lies beside the "
      "others; keep one of them, or join them into one surface";
  EXPECT_EQ(closed(surface), want);
}

TEST(SurfaceCheck, takes_a_cavity_that_faces_inwards) {
  geometry::Surface surface = corner();
  append(surface, corner(), {0.001, 0.001, 0.001}, 0.1);
  EXPECT_NE(closed(surface).find("has 2 parts, and the one with face 4 near (1, 1, 1) mm lies "
                                 "inside the others and faces outwards"),
            std::string::npos)
      << closed(surface);
  for (std::size_t t = 4; t < 8; ++t) std::swap(surface.triangles[t][0], surface.triangles[t][1]);
  EXPECT_EQ(closed(surface), "sound");
  // A body in the cavity is a part of its own.
  append(surface, corner(), {0.0011, 0.0011, 0.0011}, 0.01);
  EXPECT_NE(closed(surface).find("has 3 parts, and the one with face 8 near"), std::string::npos);
  EXPECT_NE(closed(surface).find("lies beside the others"), std::string::npos);
}

TEST(SurfaceCheck, refuses_parts_that_touch_in_a_vertex) {
  geometry::Surface surface = corner();
  surface.vertices.insert(surface.vertices.end(), {{-0.01, 0, 0}, {0, -0.01, 0}, {0, 0, -0.01}});
  for (const auto& t : {std::array{0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}})
    surface.triangles.push_back({t[0], t[1], t[2]});
  const std::string want =
      "surface `paw`: face 4 (0, 4, 5) near (0, 0, 0) mm touches face 0 in vertex 0 only; give "
      "each "
      "side a vertex of its own and move them apart, or join them";
  EXPECT_EQ(closed(surface), want);
}

TEST(SurfaceCheck, refuses_one_that_is_inside_out) {
  geometry::Surface surface = corner();
  for (auto& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(closed(surface),
            "surface `paw`: is inside out (volume -1.667e-07 m^3); turn all faces round, so that "
            "their normals point outwards");
}

// The middle of the top is pushed through the floor.
TEST(SurfaceCheck, refuses_one_that_cuts_itself) {
  geometry::Surface surface = box();
  for (Vec3& vertex : surface.vertices)
    if (vertex.z() > 0.009 && vertex.x() > 0.001 && vertex.x() < 0.009 && vertex.y() > 0.001 &&
        vertex.y() < 0.004)
      vertex.z() = -0.001;
  const std::string got = closed(surface);
  EXPECT_NE(got.find(" cut, touch or overlap each other near ("), std::string::npos) << got;
  // The lowest of its many pairs, in whatever order they were found.
  EXPECT_TRUE(got.starts_with("surface `paw`: faces 0 and 68 cut")) << got;
  EXPECT_EQ(got, closed(surface));
}

TEST(SurfaceCheck, refuses_a_vertex_that_touches_a_face) {
  geometry::Surface surface = box();
  int moved = -1;
  for (std::size_t v = 0; v < surface.vertices.size() && moved < 0; ++v) {
    const Vec3& p = surface.vertices[v];
    if (p.z() > 0.009 && p.x() > 0.001 && p.x() < 0.009 && p.y() > 0.001 && p.y() < 0.009)
      moved = static_cast<int>(v);
  }
  ASSERT_GE(moved, 0);
  auto& vertex = surface.vertices[static_cast<std::size_t>(moved)];
  vertex = {0.0042, 0.0058, 1e-9};
  EXPECT_EQ(closed(surface), "sound");
  vertex.z() = 0.0;  // exactly on the floor
  EXPECT_NE(closed(surface).find("cut, touch or overlap"), std::string::npos);
}

// Two neighbours folded onto each other in one plane share an edge, and more than that.
TEST(SurfaceCheck, refuses_a_fold) {
  const geometry::Surface fold{
      {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.006, 0}, {0.003, 0.003, -0.01}},
      {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 4}, {3, 0, 4}, {1, 3, 4}}};
  EXPECT_EQ(closed(fold),
            "surface `paw`: faces 0 and 1 cut, touch or overlap each other near (0, 0, 0) mm; "
            "remove one of them or move their vertices apart");
}

// A ring of 350 by 143 squares.
TEST(SurfaceCheck, a_hundred_thousand_faces) {
  constexpr int around = 350;
  constexpr int across = 143;
  geometry::Surface ring;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2.0 * std::numbers::pi * i / around;
      const double b = 2.0 * std::numbers::pi * j / across;
      const double radius = 0.02 + 0.01 * std::cos(b);
      ring.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), 0.01 * std::sin(b));
      const auto at = [&](int u, int v) { return u % around * across + v % across; };
      ring.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      ring.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  ASSERT_GT(ring.triangles.size(), 100000u);
  EXPECT_EQ(closed(ring), "sound");
  ring.vertices[1000] = -ring.vertices[1000];  // across the ring, through its other side
  EXPECT_NE(closed(ring).find("cut, touch or overlap"), std::string::npos);
}

}  // namespace
}  // namespace palpate::meshing
