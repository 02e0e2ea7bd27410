// A signal is heard within a step, not only between steps, and meshes are not tried for ever.
#include <gtest/gtest.h>

#include <atomic>

#include "base/error.h"
#include "base/stop_scope.h"
#include "geometry/shapes.h"
#include "mechanics/pressed_mesh.h"
#include "meshing/surface_files.h"
#include "run/solid_press.h"
#include "run_text.h"
#include "scene/first_touch.h"
#include "temporary_folder.h"

namespace palpate::run {
namespace {

TEST(Stops, AreHeardBetweenTheSolutionsOfAStep) {
  const scene::Scene scene = test::scene_of(
      "[tissue]\nyoung_modulus = \"10 kPa\"\nviscosity = \"none\"\n"
      "mesh = { kind = \"kuhn\", cells = [20, 20, 8] }\n"
      "[finger]\nradius = \"40 mm\"\n[contact]\ncoupling = \"resolved\"\n[solver]\nmodel = "
      "\"coupled_springs\"\n"
      "integrator = \"quasi_static\"\n[[step]]\nkind = \"indent\"\nto = \"3 mm\"\n",
      {});
  const Vec3 pressed = scene::first_touch(scene).finger - 1e-3 * Vec3::UnitZ();
  const auto step = [&] {
    mechanics::PressedMesh mesh(scene);
    mechanics::ContactHistory history(scene);
    mesh.set_step(1e-3);
    mechanics::Touch touch;
    touch.travel = 1e-3;
    return mesh.step(pressed, 1e-3, history, touch);
  };
  EXPECT_EQ(step(), std::nullopt);
  const std::atomic<bool> asked = true;
  const StopScope scope(asked);
  EXPECT_THROW((void)step(), Stopped);
}

// A triangle of the coarse ball, which is a cavity, lies along a side of the cube, and the smooth
// surface through its corners is beyond that side.
TEST(Stops, MeshesAreTriedForATime) {
  const auto part = [](const geometry::Shape& shape, double cell) {
    return geometry::sampled(shape, {cell, cell}).parts.front().surface;
  };
  constexpr double size = 40.0, radius = 10.0;  // mm
  geometry::Surface body = part(geometry::Cuboid{Vec3::Constant(size)}, 10.0);
  const geometry::Surface ball = part(geometry::Ellipsoid{Vec3::Constant(2.0 * radius)}, 6.0);
  const Vec3 centre = Vec3::Constant(radius);
  const Vec3 faces = geometry::twice_area(ball, 0).normalized();
  const auto turn = Eigen::Quaterniond::FromTwoVectors(faces, -Vec3::UnitX());
  const double chord = faces.dot(ball.vertices[as_index(ball.triangles[0][0])] - centre);
  const int first = static_cast<int>(body.vertices.size());
  for (const Vec3& vertex : ball.vertices)
    body.vertices.emplace_back(turn * (vertex - centre) +
                               Vec3(chord + 0.3 * (radius - chord), 0.5 * size, 0.5 * size));
  for (const auto& [a, b, c] : ball.triangles)
    body.triangles.push_back({first + a, first + c, first + b});
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "hollow.off").string();
  meshing::write_surface(file, body, 1.0);
  const scenario::Family family = scenario::parse(
      "[tissue]\nyoung_modulus = \"10 kPa\"\nviscosity = \"none\"\nshape = { file = \"" + file +
          "\", unit = \"mm\" }\n[solver]\nmodel = \"solid\"\n[finger]\nmaterial = "
          "\"rigid\"\nradius "
          "= \"8 mm\"\nat = [\"30 mm\", \"20 mm\", \"40 mm\"]\n[[step]]\nkind = \"indent\"\nto = "
          "\"1 "
          "mm\"\n",
      "test.toml", {});
  const scene::Scene scene = build_scene(family.cases.front(), family);
  EXPECT_GE(SolidPress(scene).meshes(), 1U);  // with the triangles as they are
  try {
    (void)SolidPress(scene, 0.0);
    ADD_FAILURE() << "no error";
  } catch (const MeshError& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with(
        "no mesh for the press was found, with the surface as it is or coarser (TetGen "))
        << text;
    EXPECT_TRUE(text.ends_with("); remesh it with even triangles in the program it comes from"))
        << text;
  }
}

}  // namespace
}  // namespace palpate::run
