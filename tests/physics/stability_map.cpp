// The stability map of a small block: its rows, its probes, its refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/error.h"
#include "base/stop_scope.h"
#include "stability/measure.h"
#include "stability/stability.h"

namespace palpate::stability {
namespace {

// 12 nodes, of which the upper 8 move.
scenario::Family family_of(const std::string& shape, const std::string& step) {
  return scenario::parse("[tissue]\nmaterial = \"skin\"\n" + shape + "[[step]]\n" + step,
                         "small.toml", {});
}
const std::string block =
    "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"20 mm\"] }\n"
    "mesh = { kind = \"kuhn\", cells = [1, 1, 2] }\n";
const std::string press = "kind = \"indent\"\nto = \"1 mm\"\n";

const Told nobody = [](const std::string&, double) {};

std::vector<const FailureRow*> of(const StabilityMap& map, Failure failure) {
  std::vector<const FailureRow*> rows;
  for (const FailureRow& row : map.failures)
    if (row.failure == failure) rows.push_back(&row);
  return rows;
}

void expect_limits_by_theory(const StabilityMap& map) {
  std::set<std::string> axes;
  for (const LimitRow& row : map.limits) {
    const std::string what = row.model + " " + row.volume + " " + row.integrator + " " +
                             row.damping + " " + row.axis + " " +
                             (row.value ? std::to_string(*row.value) : "");
    axes.insert(row.axis);
    if (!row.theory) {
      EXPECT_FALSE(row.measured) << what;
      EXPECT_EQ(row.failure, Failure::none) << what;
      continue;
    }
    ASSERT_TRUE(row.measured) << what;
    EXPECT_NE(row.failure, Failure::none) << what;
    const double ratio = *row.measured / *row.theory;
    if (row.model == "device")
      EXPECT_GE(ratio, 0.995) << what;  // any passive hand asks for more than none
    else
      EXPECT_NEAR(ratio, 1.0, 0.02) << what;  // what is promised
  }
  EXPECT_EQ(axes,
            (std::set<std::string>{"model", "young_modulus_Pa", "poisson_ratio", "shortest_edge_mm",
                                   "damping_per_s", "retardation_time_s", "relaxation_time_s",
                                   "contact_stiffness_N_per_m", "device_damping_N_s_per_m"}));
}

void expect_failures_by_theory(const StabilityMap& map) {
  const auto divergence = of(map, Failure::divergence);
  ASSERT_EQ(divergence.size(), 2U);  // at 0.95 and at 1.05 of the limit
  EXPECT_FALSE(divergence[0]->reached);
  EXPECT_TRUE(divergence[1]->reached);
  EXPECT_NEAR(*divergence[1]->measured, *divergence[1]->theory, 1e-4);  // other modes die away
  const auto overflow = of(map, Failure::non_finite);
  ASSERT_EQ(overflow.size(), 1U);
  EXPECT_TRUE(overflow[0]->reached);
  EXPECT_NEAR(*overflow[0]->measured, *overflow[0]->theory, 1.0);  // a whole step
  for (const FailureRow* row : of(map, Failure::drift)) {
    ASSERT_TRUE(row->theory) << row->integrator;
    EXPECT_NEAR(*row->measured, *row->theory, 1e-6) << row->integrator;  // beats of the energy
    EXPECT_EQ(row->reached, std::abs(*row->theory - 1.0) >= 1e-6) << row->integrator;
  }
  const auto inversion = of(map, Failure::inversion);
  ASSERT_EQ(inversion.size(), 1U);
  EXPECT_NEAR(*inversion[0]->measured, *inversion[0]->theory,
              1e-5 * *inversion[0]->theory);       // bisected to 1e-6
  EXPECT_NEAR(*inversion[0]->theory, 10.0, 1e-9);  // mm: the cell under the top is so high
  EXPECT_FALSE(of(map, Failure::false_equilibrium).front()->reached);  // half that way comes back
  const auto chatter = of(map, Failure::chatter);
  ASSERT_EQ(chatter.size(), 2U);
  EXPECT_FALSE(chatter[0]->reached);
  EXPECT_TRUE(chatter[1]->reached);
  EXPECT_EQ(of(map, Failure::locking).size(), 4U);
}

TEST(StabilityMap, IsByTheory) {
  const scenario::Family family = family_of(block, press);
  int told = 0;
  const auto tell = [&](const std::string&, double share) {
    ++told;
    EXPECT_LE(share, 1.0);
  };
  const StabilityMap map = map_stability(family.cases.front(), family, tell);
  EXPECT_GT(told, 100);
  expect_limits_by_theory(map);
  expect_failures_by_theory(map);
  EXPECT_GE(map.sentences.size(), 6U);
}

TEST(StabilityMap, EndsEarlyWhereItIsTold) {
  const scenario::Family family = family_of(block, press);
  const std::atomic<bool> now = true;
  const StopScope scope(now);
  EXPECT_THROW((void)map_stability(family.cases.front(), family, nobody), Stopped);
}

// The surfaces of the limb alone have 203 vertices; elements twice as long would need 33 nodes.
TEST(StabilityMap, LeavesOutMeshesThatCannotBeMade) {
  const scenario::Family family = family_of(
      "shape = { kind = \"layered_limb\" }\nmesh = { kind = \"tetgen\", nodes = 260 }\n", press);
  std::atomic<bool> stop = false;
  const Told tell = [&](const std::string& what, double) { stop = stop || what == "damping"; };
  Survey survey;
  survey.one = &family.cases.front();
  survey.family = &family;
  survey.told = &tell;
  survey.given = model_and_volume(survey.one->scenario);
  survey.own = survey.make_body(survey.given);
  const StopScope scope(stop);
  EXPECT_THROW(survey_axes(survey), Stopped);
  ASSERT_FALSE(survey.map.sentences.empty());
  EXPECT_NE(
      survey.map.sentences.front().find("Elements 2 times as long were excluded: no mesh near"),
      std::string::npos)
      << survey.map.sentences.front();
  int sizes = 0;
  for (const LimitRow& row : survey.map.limits) sizes += row.axis == "shortest_edge_mm" ? 1 : 0;
  EXPECT_GE(sizes, 1);
}

TEST(StabilityMap, RefusesWhatHasNoMeshAndTooLargeOnes) {
  const auto refused = [](const std::string& shape) -> std::string {
    const scenario::Family family = family_of(shape, press);
    try {
      (void)map_stability(family.cases.front(), family, nobody);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused("shape = { kind = \"half_space\" }\n")
                .find("small.toml:3:9: a `half_space` has no mesh"),
            std::string::npos);
  EXPECT_NE(refused("mesh = { kind = \"kuhn\", cells = [9, 9, 10] }\n")
                .find("meshes of up to 1000 nodes, and this one has 1100"),
            std::string::npos);
}

// Below its limit a struck body stays bounded, above it grows, far above its numbers break.
TEST(FreeMotion, Endings) {
  const scenario::Family family = family_of(block, press);
  scene::SpecimenShapes shapes;
  const auto probed =
      make_probed_body(bare(family.cases.front(), scenario::Solver::Model::coupled_springs,
                            scenario::Solver::Volume::nodal),
                       family, shapes);
  const FreeMotion motion{
      .scene = &probed->scene, .body = probed->elastic.get(), .mode = probed->highest};
  const double limit = 2.0 / probed->highest.frequency;
  EXPECT_EQ(move(motion, 0.999 * limit).failure, Failure::none);
  EXPECT_EQ(move(motion, 1.001 * limit).failure, Failure::divergence);
  EXPECT_EQ(move(motion, 2.0 * limit, HUGE_VAL).failure, Failure::non_finite);
  EXPECT_EQ(move(motion, 0.999 * limit).steps, motion.steps);
}

TEST(FailureWords, AreOnes) {
  EXPECT_STREQ(failure_word(Failure::none), "none");
  EXPECT_STREQ(failure_word(Failure::false_equilibrium), "false_equilibrium");
  EXPECT_STREQ(failure_word(Failure::chatter), "chatter");
}

}  // namespace
}  // namespace palpate::stability
