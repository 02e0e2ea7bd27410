// What a picture of a scene shows: faces that end where the support and the layers end.
#include "run/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geometry/shape_loops.h"
#include "meshing/surface_files.h"
#include "revolved_bodies.h"
#include "scene_text.h"

namespace palpate::run {
namespace {

using Face = record::ScenePicture::Face;

std::array<double, 2> heights(const Face& face) {
  std::array<double, 3> z{};
  for (std::size_t i = 0; i < 3; ++i) z[i] = face.corners[i].z();
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  return {*low, *high};
}

// A lying cylinder of 60 mm is held up to 6 mm.
TEST(Picture, TheSupportEndsAtItsHeight) {
  const record::ScenePicture picture =
      picture_of(test::scene_of("[tissue]\nshape = { kind = \"cylinder\" }\n[solver]\nmodel = "
                                "\"solid\"\n[[step]]\nkind = \"indent\"\n"));
  double area = 0.0, held = 0.0;
  for (const Face& face : picture.faces) {
    const auto [low, high] = heights(face);
    if (face.held)
      EXPECT_LE(high, 6e-3 + 1e-7);
    else
      EXPECT_GE(low, 6e-3 - 1e-7);
    const auto& [a, b, c] = face.corners;
    const double own = 0.5 * (b - a).cross(c - a).norm();
    area += own;
    held += face.held ? own : 0.0;
  }
  // Of the round surface acos(0.8)/pi; of each end the segment.
  const double r = 30.0, l = 80.0, angle = std::acos(0.8);
  const double of_ends = 2.0 * r * r * (angle - 0.8 * 0.6);
  EXPECT_NEAR(held / area, (2.0 * r * l * angle + of_ends) / (2.0 * M_PI * r * (l + r)), 0.002);
}

// A plate on a stem whose flat end is 0.8 % of the surface, but sharp.
TEST(Picture, ShowsTheBaseThatIsComputed) {
  const test::TemporaryFolder folder;
  test::Profile profile;
  test::add_line(profile, {0.0, 30.0}, {30.0, 30.0}, 6.0);
  test::add_line(profile, {30.0, 30.0}, {30.0, 24.0}, 6.0);
  test::add_line(profile, {30.0, 24.0}, {4.0, 24.0}, 6.0);
  test::add_line(profile, {4.0, 24.0}, {4.0, 0.0}, 4.0);
  test::add_base(profile, 4.0, 2.0);
  (void)test::write_surface(profile, 4.0, folder / "stem.off");
  const record::ScenePicture picture = picture_of(test::scene_of(
      "[tissue]\nshape = { file = \"" + (folder / "stem.off").string() +
      "\", unit = \"mm\" }\n[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\n"));
  int held = 0;
  for (const Face& face : picture.faces) {
    if (!face.held) continue;
    ++held;
    EXPECT_LT(heights(face)[1], 1e-6);
  }
  EXPECT_GT(held, 4);
}

TEST(Picture, BetweenPlatesThereIsALoadAndNoFinger) {
  const auto load = [](const std::string& step) {
    const record::ScenePicture picture = picture_of(test::scene_of(
        "[tissue]\nmesh = { kind = \"kuhn\", cells = [2, 2, 2] }\n[[step]]\n" + step));
    EXPECT_TRUE(picture.finger.empty());
    EXPECT_EQ(picture.base, "on a table (slides)");
    return picture.load;
  };
  EXPECT_EQ(load("kind = \"creep\"\nstress = \"2 kPa\"\n"), "2 kPa");
  EXPECT_EQ(load("kind = \"relax\"\nstrain = 0.04\n"), "a strain of 4 %");
  EXPECT_EQ(load("kind = \"compress\"\nstrain = 0.2\n"), "a strain of 20 %");
}

// Of a ball with more triangles than a picture has: the border of the base is a circle.
TEST(Picture, TheBorderOfTheBaseStaysWhereItIs) {
  const test::TemporaryFolder folder;
  const geometry::Surface ball =
      geometry::ellipsoid_surface(Vec3::Constant(30.0), Vec3::Constant(60.0), 1.5);
  EXPECT_GT(ball.triangles.size(), 6000U);
  meshing::write_surface(folder / "ball.off", ball, 1.0);
  const record::ScenePicture picture = picture_of(test::scene_of(
      "[tissue]\nshape = { file = \"" + (folder / "ball.off").string() +
      "\", unit = \"mm\" }\n[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\n"));
  EXPECT_LT(picture.faces.size(), 6001U);
  std::array<std::set<std::array<double, 3>>, 2> corners;
  for (const Face& face : picture.faces)
    for (const Vec3& corner : face.corners)
      corners[face.held ? 1 : 0].insert({corner.x(), corner.y(), corner.z()});
  int border = 0;
  for (const auto& [x, y, z] : corners[1]) {
    if (!corners[0].contains({x, y, z})) continue;
    ++border;
    EXPECT_NEAR(z, 6e-3, 1e-6);
    EXPECT_NEAR((Vec3(x, y, z) - Vec3::Constant(30e-3)).norm(), 30e-3,
                0.03e-3);  // chords of 1.5 mm
  }
  EXPECT_GT(border, 40);
}

TEST(Picture, ALayerEndsAtItsHeight) {
  const record::ScenePicture picture = picture_of(
      test::scene_of("[tissue]\nshape = { kind = \"cuboid\" }\n[[region]]\nkind = \"slab\"\n"
                     "bottom = \"0 mm\"\ntop = \"17 mm\"\nyoung_modulus = \"50 kPa\"\n"
                     "[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\n"));
  int of_layer = 0;
  for (const Face& face : picture.faces) {
    const auto [low, high] = heights(face);
    of_layer += face.region == 1 ? 1 : 0;
    if (face.region == 1)
      EXPECT_LE(high, 17e-3 + 1e-7);
    else
      EXPECT_GE(low, 17e-3 - 1e-7);
  }
  EXPECT_GT(of_layer, 4);
}

}  // namespace
}  // namespace palpate::run
