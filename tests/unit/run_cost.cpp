// What a run is said to take beside what it takes.

#include <gtest/gtest.h>

#include "base/stopwatch.h"
#include "run/family.h"
#include "scenario/family.h"

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
  const double expected = expected_cost(all).seconds;
  const double before = processor_seconds();
  for (const scene::Scene& scene : all) (void)run_case(scene);
  const double spent = processor_seconds() - before;
  EXPECT_GT(expected, spent / 3.0);  // the machine has other work, which slows both
  EXPECT_LT(expected, 3.0 * spent);
}

// Cases that would take long are stopped, and count by how far they have come: a thousand times the
// time of the press takes a thousand times as long.
TEST(Costs, GrowWithTheLoadingHistoryThatIsLeft) {
  const double quick = expected_cost(scenes("2 mm/s")).seconds;
  const double before = processor_seconds();
  const double slow = expected_cost(scenes("0.002 mm/s")).seconds;
  EXPECT_LT(processor_seconds() - before, 15.0);  // s; the limit is three on an idle machine
  EXPECT_GT(slow, 200.0 * quick);                 // rows cost too, and the steps' costs differ
  EXPECT_LT(slow, 5000.0 * quick);
}

// A press of the solid that is stopped has no rows by which to tell the rest.
TEST(Costs, OfASolidThatDoesNotEndAreABound) {
  const std::vector<scene::Scene> one = build_all(
      scenario::parse("[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n",
                      "press.toml", {}),
      1);
  EXPECT_TRUE(expected_cost(one, 1e-3).at_least);
  EXPECT_FALSE(expected_cost(one, 60.0).at_least);
}

}  // namespace
}  // namespace palpate::run
