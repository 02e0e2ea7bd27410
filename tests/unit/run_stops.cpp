// A signal is heard within a step, not only between steps.
#include <gtest/gtest.h>

#include <atomic>

#include "base/stop_scope.h"
#include "mechanics/pressed_mesh.h"
#include "run_text.h"
#include "scene/first_touch.h"

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

}  // namespace
}  // namespace palpate::run
