// What a run is said to take beside what it takes.

#include <gtest/gtest.h>

#include "base/stopwatch.h"
#include "geometry/shape_loops.h"
#include "run/family.h"
#include "run/solid_press.h"
#include "scenario/family.h"
#include "surface_file.h"
#include "temporary_folder.h"

namespace palpate::run {
namespace {

// The loading history takes `seconds` of simulated time on a small mesh.
std::vector<scene::Scene> scenes(const std::string& rate) {
  return build_all(
      scenario::parse("[tissue]\nmesh = { kind = \"kuhn\", cells = [3, 3, 3] }\n"
                      "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n"
                      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"" +
                          rate +
                          "\"\n[output]\ninterval = \"10 ms\"\npressure_maps = false\n"
                          "[sweep]\n\"finger.radius\" = [\"10 mm\", \"11 mm\", \"12 mm\"]\n",
                      "press.toml", {}),
      1);
}

TEST(Costs, AreThoseOfTheCasesThatFinish) {
  const std::vector<scene::Scene> all = scenes("2 mm/s");
  const double expected = expected_seconds(all);
  const double before = processor_seconds();
  for (const scene::Scene& scene : all) (void)run_case(scene);
  const double spent = processor_seconds() - before;
  EXPECT_GT(expected, spent / 3.0);  // the machine has other work, which slows both
  EXPECT_LT(expected, 3.0 * spent);
}

// The wall of a hollow ball gives way, so that it is pressed in steps on two meshes: some seconds.
TEST(Costs, OfASolidFromItsMeshesAndItsPress) {
  geometry::Surface ball = geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(0.060), 6e-3);
  const geometry::Surface inside =
      geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(0.056), 6e-3);
  const auto outer = static_cast<int>(ball.vertices.size());
  ball.vertices.insert(ball.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& [a, b, c] : inside.triangles)
    ball.triangles.push_back({outer + a, outer + c, outer + b});
  const test::TemporaryFolder folder;
  test::write_off(folder / "ball.off", ball);
  const std::vector<scene::Scene> all = build_all(
      scenario::parse("[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.4\n"
                      "viscosity = \"none\"\nshape = { file = \"" +
                          (folder / "ball.off").string() +
                          "\", unit = \"mm\" }\n[finger]\nradius = \"8 mm\"\n[solver]\n"
                          "model = \"solid\"\n[[step]]\nkind = \"indent\"\nto = \"3 mm\"\n",
                      "press.toml", {}),
      1);
  SolidPress press(all.front());
  EXPECT_LT(press.progress(), 0.1);
  const double expected = expected_seconds(all);
  const double before = processor_seconds();
  const record::CaseRecord record = run_case(all.front());
  const double spent = processor_seconds() - before;
  EXPECT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  EXPECT_GT(expected, spent / 3.0);  // the machine has other work, which slows both
  EXPECT_LT(expected, 3.0 * spent);
  mechanics::Touch touch;
  touch.travel = 0.001;
  EXPECT_EQ(press.find({}, touch), std::nullopt);
  EXPECT_EQ(press.progress(), 1.0);  // the curve is found to the deepest travel at once
}

// Cases that would take long are stopped, and count by how far they have come: a thousand times the
// time of the press takes a thousand times as long.
TEST(Costs, GrowWithTheLoadingHistoryThatIsLeft) {
  const double quick = expected_seconds(scenes("2 mm/s"));
  const double before = processor_seconds();
  const double slow = expected_seconds(scenes("0.002 mm/s"));
  EXPECT_LT(processor_seconds() - before, 15.0);  // s; the limit is three on an idle machine
  EXPECT_GT(slow, 200.0 * quick);                 // rows cost too, and the steps' costs differ
  EXPECT_LT(slow, 5000.0 * quick);
}

}  // namespace
}  // namespace palpate::run
