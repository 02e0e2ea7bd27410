// The model beside a device is the model of `run`, and closed forms allocate nothing.
#include "live/loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "counted_memory.h"
#include "run_text.h"

namespace palpate::live {
namespace {

const std::string viscous =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nshape = { kind = \"half_space\" }\n"
    "viscosity = \"standard_linear_solid\"\n[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n"
    "[solver]\nmodel = \"hertz\"\n";
const std::string layer =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", "
    "\"60 mm\", "
    "\"10 mm\"] }\nviscosity = \"standard_linear_solid\"\n[solver]\nmodel = \"layer\"\n";
const std::string modal =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nmesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"modal\"\n";
const std::string press_programme =
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"10 mm/s\"\n"
    "[[step]]\nkind = \"hold\"\ntime = \"0.1 s\"\n"
    "[[step]]\nkind = \"retract\"\nto = \"0 mm\"\nrate = \"10 mm/s\"\n"
    "[output]\ninterval = \"1 ms\"\npressure_maps = false\n";

struct ModelCase {
  const char* name;
  const std::string* text;
};
void PrintTo(const ModelCase& model, std::ostream* out) { *out << model.name; }

class LiveModels : public testing::TestWithParam<ModelCase> {};

// Offline's rows as the way of a device: the same forces again, at every row.
TEST_P(LiveModels, FollowsOfflinesWayWithOfflinesForces) {
  const scene::Scene scene = test::scene_of(*GetParam().text + press_programme);
  const record::CaseRecord offline = test::run_scene(scene);
  ASSERT_EQ(offline.contact.size(), 301U);
  LiveModel model(scene);
  double greatest = 0.0;
  for (const record::ContactRow& row : offline.contact) {
    ASSERT_FALSE(model.follow(Vec3(0.0, 0.0, -row.travel), row.time));
    greatest = std::max(greatest, row.force);
    // A relative 1e-9: the step of a frame is a difference of two times here, with their rounding.
    EXPECT_NEAR(model.touch().force(), row.force, 1e-9 * greatest) << "at " << row.time;
    EXPECT_NEAR(model.force().z(), model.touch().force(), 1e-12);
  }
  EXPECT_GT(greatest, 0.05);
}
INSTANTIATE_TEST_SUITE_P(All, LiveModels,
                         testing::Values(ModelCase{"hertz", &viscous}, ModelCase{"layer", &layer},
                                         ModelCase{"modal", &modal}),
                         [](const auto& one) { return one.param.name; });

// A device reads every 20 ms, a mesh moves every 1 ms on a straight way between the readings.
TEST(LiveModel, TakesTheStepsOfAMeshBetweenReadings) {
  const scene::Scene scene = test::scene_of(modal + press_programme);
  LiveModel often(scene);
  LiveModel seldom(scene);
  for (int i = 0; i <= 100; ++i) {
    const Vec3 place(0.0, 0.0, -1e-5 * i);
    ASSERT_FALSE(often.follow(place, 1e-3 * i));
    if (i % 20 != 0) continue;
    ASSERT_FALSE(seldom.follow(place, 1e-3 * i));
    EXPECT_NEAR(seldom.touch().force(), often.touch().force(), 1e-12);
    EXPECT_NEAR(seldom.touch().travel, 1e-5 * i, 1e-15);
  }
  // A reading between two steps waits for the next.
  const double force = seldom.touch().force();
  ASSERT_FALSE(seldom.follow(Vec3(0.0, 0.0, -2e-3), 0.1005));
  EXPECT_EQ(seldom.touch().force(), force);
}

// A hand that goes sideways on the flat feels the same; above the surface it feels nothing.
TEST(LiveModel, GoesSidewaysAndAway) {
  const scene::Scene scene = test::scene_of(viscous + press_programme);
  LiveModel here(scene);
  LiveModel there(scene);
  for (int i = 0; i <= 10; ++i) {
    ASSERT_FALSE(here.follow(Vec3(0.0, 0.0, -1e-4 * i), 1e-2 * i));
    ASSERT_FALSE(there.follow(Vec3(2e-3 * i, -1e-3 * i, -1e-4 * i), 1e-2 * i));
  }
  EXPECT_EQ(here.touch().force(), there.touch().force());
  EXPECT_NEAR(there.touch().slide, 1e-2 * std::sqrt(5.0), 1e-12);
  ASSERT_FALSE(here.follow(Vec3(0.0, 0.0, 0.05), 0.2));
  EXPECT_EQ(here.touch().force(), 0.0);
  EXPECT_TRUE(here.touch().contacts.empty());
}

TEST(LiveModel, StaysWrongWhereItEnds) {
  const scene::Scene scene = test::scene_of(
      "schema = 1\n[tissue]\nmaterial = \"skin\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", "
      "\"60 mm\", \"1 mm\"] }\n[solver]\nmodel = \"layer\"\n[[step]]\nkind = \"indent\"\n"
      "to = \"0.5 mm\"\nrate = \"10 mm/s\"\n");
  LiveModel model(scene);
  ASSERT_FALSE(model.follow(Vec3::Zero(), 0.0));
  EXPECT_TRUE(model.follow(Vec3(0.0, 0.0, -4e-3), 0.1)) << "deeper than the law goes";
  EXPECT_TRUE(model.follow(Vec3::Zero(), 0.2)) << "its memory is not to be trusted any more";
}

// Everything is allocated before the loop begins: also for contacts that come and go.
TEST(LiveModel, ClosedFormsAllocateNothing) {
  for (const std::string* text : {&viscous, &layer}) {
    const scene::Scene scene = test::scene_of(*text + press_programme);
    LiveModel model(scene);
    const std::size_t before = test::blocks_taken;
    double sum = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double travel = 1e-3 * std::sin(0.01 * i);
      (void)model.follow(Vec3(0.0, 0.0, -travel), 1e-3 * i);
      sum += model.force().z();
    }
    EXPECT_EQ(test::blocks_taken - before, 0U);
    EXPECT_GT(sum, 1.0);
  }
  const std::size_t before = test::blocks_taken;
  const std::vector<int> counted(1000);
  EXPECT_EQ(test::blocks_taken - before, 1U) << "the counter counts";
}

TEST(LiveModel, PredictsTheForceOfTheDeepestTravel) {
  const scene::Scene scene = test::scene_of(viscous + press_programme);
  LiveModel pressed(scene);
  const FrameCost cost = predict_cost(scene, pressed, 1e-3, 100);
  EXPECT_GT(cost.median, 0.0);
  EXPECT_GE(cost.p99, cost.median);
  LiveModel model(scene);
  for (int i = 0; i <= 200; ++i)
    ASSERT_FALSE(model.follow(Vec3(0.0, 0.0, -1e-3 * i / 200.0), 1e-3 * i));
  EXPECT_NEAR(cost.force, model.touch().force(), 1e-12);
}

// After the prediction the model forgets it: its forces are those of a new one, to the bit.
TEST(LiveModel, StartsAgain) {
  for (const std::string* text : {&viscous, &layer, &modal}) {
    const scene::Scene scene = test::scene_of(*text + press_programme);
    LiveModel again(scene);
    (void)predict_cost(scene, again, 1e-3, 50);
    ASSERT_TRUE(again.start_again());
    LiveModel fresh(scene);
    for (int i = 0; i <= 50; ++i) {
      const Vec3 place(0.0, 0.0, -2e-5 * i);
      ASSERT_FALSE(again.follow(place, 0.5 + 1e-3 * i));
      ASSERT_FALSE(fresh.follow(place, 0.5 + 1e-3 * i));
      EXPECT_EQ(again.touch().force(), fresh.touch().force()) << "frame " << i;
    }
    EXPECT_GT(fresh.touch().force(), 0.01);
  }
}

}  // namespace
}  // namespace palpate::live
