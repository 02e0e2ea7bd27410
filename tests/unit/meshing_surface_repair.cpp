// Faults of scans that are mended, each told; what is worse is refused with its size.
#include "meshing/surface_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "geometry/shapes.h"
#include "refusal.h"

namespace palpate::meshing {
namespace {

using geometry::Surface;

// An ellipsoid of 80 x 60 x 40 mm; its volume is that of the polyhedron.
Surface body() {
  return geometry::sampled(geometry::Ellipsoid{Vec3(0.08, 0.06, 0.04)}, {0.004, 0.004})
      .parts.front()
      .surface;
}

Surface with(Surface one, const Surface& other, const Vec3& shift, double scale, bool inwards) {
  const int first = static_cast<int>(one.vertices.size());
  for (const Vec3& vertex : other.vertices) one.vertices.push_back(scale * vertex + shift);
  for (auto [a, b, c] : other.triangles) {
    if (inwards) std::swap(b, c);
    one.triangles.push_back({first + a, first + b, first + c});
  }
  return one;
}

// Mends it and requires the volume of the body, within `part` of it.
std::string told(const Surface& broken, double part) {
  const WholeSurface whole = whole_surface(broken, "paw", {});
  check_closed(whole.surface, "mended");
  const double volume = geometry::enclosed(body()).volume;
  EXPECT_NEAR(geometry::enclosed(whole.surface).volume, volume, part * volume);
  return whole.warning;
}

constexpr double rounding = 1e-9;  // where no vertex moves

TEST(SurfaceRepair, a_sound_surface_stays_to_the_bit) {
  const WholeSurface whole = whole_surface(body(), "paw", {});
  EXPECT_EQ(whole.surface.vertices, body().vertices);
  EXPECT_EQ(whole.surface.triangles, body().triangles);
  EXPECT_EQ(whole.warning, "");
}

TEST(SurfaceRepair, small_holes_are_closed) {
  Surface open = body();
  open.triangles.erase(open.triangles.begin() + 100);
  open.triangles.erase(open.triangles.begin() + 700);
  const std::string text = told(open, 0.001);  // two flat triangles on a curved surface
  EXPECT_TRUE(text.starts_with("the surface of paw was mended: 2 holes closed with ")) << text;
  EXPECT_NE(text.find(" mm around near ("), std::string::npos) << text;
}

TEST(SurfaceRepair, doubled_and_turned_triangles_are_mended) {
  Surface doubled = body();
  doubled.triangles.push_back(doubled.triangles[7]);
  EXPECT_EQ(told(doubled, rounding),
            "the surface of paw was mended: 1 doubled or flat triangle removed");
  Surface pinched = body();
  pinched.triangles.push_back(
      {pinched.triangles[7][0], pinched.triangles[7][1], pinched.triangles[7][1]});
  EXPECT_EQ(told(pinched, rounding),
            "the surface of paw was mended: 1 doubled or flat triangle removed");
  Surface turned = body();
  for (std::size_t t = 0; t < turned.triangles.size(); t += 5)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  EXPECT_EQ(told(turned, rounding), "the surface of paw was mended: all triangles turned outwards");
}

TEST(SurfaceRepair, vertices_in_one_place_are_joined) {
  Surface apart;
  const Surface whole = body();
  for (const auto& triangle : whole.triangles) {
    for (const int corner : triangle)
      apart.vertices.push_back(whole.vertices[as_index(corner)] +
                               2e-8 * Vec3::Unit(static_cast<int>(apart.vertices.size()) % 3));
    const int next = static_cast<int>(apart.vertices.size());
    apart.triangles.push_back({next - 3, next - 2, next - 1});
  }
  EXPECT_NE(told(apart, 1e-5).find("joined to another in the same place"), std::string::npos);
}

TEST(SurfaceRepair, triangles_that_cross_are_replaced) {
  // A vertex beside the tip that lies outside on the other side.
  for (const Vec3& shift : {Vec3(0.0, 0.0, -0.011), Vec3(0.002, 0.001, -0.012)}) {
    Surface folded = body();
    *std::max_element(folded.vertices.begin(), folded.vertices.end(),
                      [](const Vec3& a, const Vec3& b) {
                        return a.x() + 0.4 * a.z() < b.x() + 0.4 * b.z();
                      }) += shift;
    const std::string text = told(folded, 0.01);
    EXPECT_NE(text.find("triangles that cut each other replaced, "), std::string::npos) << text;
  }
}

TEST(SurfaceRepair, specks_are_left_out_and_one_of_several_parts_is_taken) {
  const std::string speck = told(with(body(), body(), Vec3(0.1, 0, 0), 0.02, false), rounding);
  EXPECT_NE(speck.find("part 1 of 2 is taken, and 1 speck excluded"), std::string::npos) << speck;
  const Surface two = with(body(), body(), Vec3(0.2, 0, 0), 0.5, false);
  const std::string text = told(two, rounding);
  EXPECT_NE(text.find("part 1 of 2 is taken, without part 2 near ("), std::string::npos) << text;
  const Surface second = whole_surface(two, "paw", {.part = 2}).surface;
  EXPECT_NEAR(geometry::enclosed(second).volume, 0.125 * geometry::enclosed(body()).volume, 1e-12);
}

// A place inside the larger one is nearest to the walls of neither the cavity nor the part that
// cuts.
TEST(SurfaceRepair, the_part_nearest_to_the_finger_is_pressed) {
  const Surface two = with(body(), body(), Vec3(0.2, 0, 0), 0.5, false);
  const double volume = geometry::enclosed(body()).volume;
  const WholeSurface second = whole_surface(two, "paw", {.pressed = Vec3(0.25, 0.0, 0.05)});
  EXPECT_NEAR(geometry::enclosed(second.surface).volume, 0.125 * volume, 1e-12);
  EXPECT_NE(second.warning.find("part 2 of 2 is taken, the nearest to the finger"),
            std::string::npos)
      << second.warning;
  const Vec3 left(-0.01, 0.02, 0.02);
  EXPECT_NEAR(geometry::enclosed(whole_surface(two, "paw", {.pressed = left}).surface).volume,
              volume, 1e-12);
  const Vec3 shift(0.02, 0.015, 0.01);
  const Surface hollow = with(body(), body(), shift, 0.5, true);
  const geometry::Enclosed cavity = geometry::enclosed(with({}, body(), shift, 0.5, false));
  EXPECT_NEAR(
      geometry::enclosed(whole_surface(hollow, "paw", {.pressed = cavity.centroid}).surface).volume,
      0.875 * volume, 1e-12);
}

TEST(SurfaceRepair, the_smallest_of_many_parts_are_counted) {
  Surface many = body();
  for (int i = 1; i < 7; ++i) many = with(many, body(), Vec3(0.1 * i, 0, 0), 0.5, false);
  const std::string text = told(many, rounding);
  EXPECT_NE(text.find("without part 2 near ("), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(" of its volume, and 3 smaller parts")) << text;
}

// A public rabbit has legs, eyes and teeth that stand in its body.
TEST(SurfaceRepair, a_part_that_cuts_the_one_taken_is_neither_a_cavity_nor_a_fault) {
  for (const double scale : {0.9, 0.5}) {
    const std::string text =
        told(with(body(), body(), Vec3(0.05, 0.015, 0.01), scale, false), rounding);
    EXPECT_NE(text.find("part 1 of 2 is taken, without part 2 near ("), std::string::npos) << text;
    EXPECT_TRUE(
        text.ends_with(" of its volume, which cuts or touches it; join what cuts or touches "
                       "it to one surface if both are the body"))
        << text;
  }
}

// However their triangles are turned; what lies in the cavity is excluded.
TEST(SurfaceRepair, parts_inside_the_largest_are_cavities) {
  const double volume = geometry::enclosed(body()).volume;
  const Vec3 shift(0.02, 0.015, 0.01);
  for (const bool inwards : {true, false}) {
    const Surface hollow = with(body(), body(), shift, 0.5, inwards);
    const WholeSurface whole = whole_surface(hollow, "paw", {});
    check_closed(whole.surface, "hollow");
    EXPECT_NEAR(geometry::enclosed(whole.surface).volume, 0.875 * volume, 1e-12);
    EXPECT_NE(whole.warning.find("part 1 of 2 is taken, with a cavity in it: part 2 near (40, 30, "
                                 "20) mm with 13 % of its volume"),
              std::string::npos)
        << whole.warning;
    EXPECT_EQ(whole.warning.find("was mended") != std::string::npos, !inwards);
    // Asked for by its number, a part is filled.
    const Surface filled = whole_surface(hollow, "paw", {.part = 1}).surface;
    EXPECT_NEAR(geometry::enclosed(filled).volume, volume, 1e-12);
    const Surface inner = whole_surface(hollow, "paw", {.part = 2}).surface;
    EXPECT_NEAR(geometry::enclosed(inner).volume, 0.125 * volume, 1e-12);
  }
  const Surface three =
      with(with(body(), body(), shift, 0.5, true), body(), Vec3(0.03, 0.0225, 0.015), 0.25, false);
  const WholeSurface whole = whole_surface(three, "paw", {});
  EXPECT_NEAR(geometry::enclosed(whole.surface).volume, 0.875 * volume, 1e-12);
  EXPECT_NE(whole.warning.find("without part 3"), std::string::npos) << whole.warning;
}

TEST(SurfaceRepair, what_is_worse_is_refused_with_its_size) {
  Surface open = body();
  std::erase_if(open.triangles, [&](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](int vertex) { return open.vertices[as_index(vertex)].z() > 0.03; });
  });
  const auto refusal = [](const Surface& surface, const RepairOrder& order) {
    return test::refusal<MeshError>([&] { return whole_surface(surface, "paw", order); });
  };
  const std::string wide = refusal(open, {});
  EXPECT_TRUE(wide.starts_with("surface `paw`: is open: 1 hole would need ")) << wide;
  const auto at = wide.find("set `repair_up_to = ");
  ASSERT_NE(at, std::string::npos) << wide;
  const double enough = std::stod(wide.substr(at + 20));
  const Surface closed = whole_surface(open, "paw", {.most_missing = enough}).surface;
  EXPECT_LT(geometry::enclosed(closed).volume, geometry::enclosed(body()).volume);
  EXPECT_NE(refusal(open, {.most_missing = enough - 0.01}).find("is open"), std::string::npos);
  Surface doubled = body();
  doubled.triangles.push_back(doubled.triangles[7]);
  EXPECT_NE(refusal(doubled, {.repair = false}).find("have the same vertices"), std::string::npos);
  EXPECT_NE(refusal(body(), {.part = 3}).find("has 1 part, and `part` is 3"), std::string::npos);
  EXPECT_EQ(refusal({{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}}, {}),
            "surface `paw`: is a flat sheet: all its vertices have the same z; give the whole "
            "surface of a body, around its inside");
}

}  // namespace
}  // namespace palpate::meshing
