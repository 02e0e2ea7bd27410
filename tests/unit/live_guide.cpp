// The programme as guidance, and the surface that is felt.
#include "live/loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "live/touch.h"

namespace palpate::live {
namespace {

std::vector<scenario::Step> guided_steps() {
  scenario::Indent to_travel;
  to_travel.to = {2e-3, false};
  scenario::Hold hold;
  hold.time = 0.5;
  scenario::Slide slide;
  slide.by = 3e-3;
  scenario::Indent to_force;
  to_force.to = {1.5, true};
  scenario::Retract retract;
  retract.to = 0.0;
  return {to_travel, hold, slide, to_force, retract};
}

GuidePlace at(double time, double travel, double force = 0.0, double x = 0.0) {
  return {time, Vec3(x, 0.0, -travel), force};
}

TEST(Guide, EndsEachStepByWhatWasReached) {
  const auto steps = guided_steps();
  Guide guide(steps);
  guide.pass(at(0.0, -5e-3));
  guide.pass(at(0.1, 1.999e-3));
  EXPECT_EQ(guide.step(), 1);
  guide.pass(at(0.2, 2e-3));
  EXPECT_EQ(guide.step(), 2) << "a hold from 0.2 s";
  guide.pass(at(0.69, 2.5e-3));
  EXPECT_EQ(guide.step(), 2);
  guide.pass(at(0.71, 2.5e-3, 0.0, 1e-3));
  EXPECT_EQ(guide.step(), 3) << "a slide from x = 1 mm";
  guide.pass(at(0.8, 2.5e-3, 0.0, 3.9e-3));
  EXPECT_EQ(guide.step(), 3);
  guide.pass(at(0.9, 2.5e-3, 0.0, -2.1e-3));
  EXPECT_EQ(guide.step(), 4);
  guide.pass(at(1.0, 9e-3, 1.49));
  EXPECT_EQ(guide.step(), 4) << "until a force, whatever the travel";
  guide.pass(at(1.1, 3e-3, 1.5));
  EXPECT_EQ(guide.step(), 5);
  guide.pass(at(1.2, 1e-6));
  EXPECT_FALSE(guide.done());
  guide.pass(at(1.3, 0.0));
  EXPECT_TRUE(guide.done());
  EXPECT_EQ(guide.step(), 5);
  guide.pass(at(1.4, 2e-3));
  EXPECT_TRUE(guide.done()) << "over is over";
}

TEST(Guide, SaysWhatTheHandIsToDo) {
  const auto steps = guided_steps();
  EXPECT_EQ(guidance(steps[0]), "press to 2 mm at about 5 mm/s");
  EXPECT_EQ(guidance(steps[1]), "hold still for 0.5 s");
  EXPECT_EQ(guidance(steps[2]), "slide sideways by 3 mm at about 5 mm/s");
  EXPECT_EQ(guidance(steps[3]), "press until the force is 1.5 N at about 5 mm/s");
  EXPECT_EQ(guidance(steps[4]), "withdraw to 0 mm at about 5 mm/s");
}

TEST(StraightLine, FindsWhereAHertzContactBegan) {
  for (const double stiffness : {1e2, 1e5}) {  // N m^(-3/2)
    StraightLine line;
    for (int i = 1; i <= 20; ++i) {
      const double depth = 1e-4 + 1e-5 * i;
      line.add(-0.037 - depth, linear_in_depth(stiffness * depth * std::sqrt(depth)));
    }
    ASSERT_TRUE(line.found());
    EXPECT_NEAR(line.found()->zero, -0.037, 1e-12);  // rounding
    EXPECT_NEAR(line.found()->slope, -std::cbrt(stiffness * stiffness),
                1e-9 * std::cbrt(stiffness * stiffness));
  }
}

// A press at 0.5 mm/s on tissue that relaxes, with pauses, from 1 mm above the surface: a line
// through F^(2/3) would be 0.1 mm off. The truth is summed directly from [viscous], step by step.
TEST(SurfaceSearch, FindsTheSurfaceOfRelaxingTissueInNoise) {
  const contact::Relaxation relaxation{.branches = {{0.5, 1.5}}};
  constexpr double surface = -2e-3;  // m
  std::mt19937 generator(1);
  for (const double noise : {0.0, 1e-3, 10e-3}) {
    std::normal_distribution<double> scatter(0.0, noise);
    double worst = 0.0;
    double stated = 0.0;
    for (int run = 0; run < 20; ++run) {
      SurfaceSearch search(relaxation);
      std::vector<double> growth;  // of h^(3/2), by step of 1 ms
      double before = 0.0;
      double z = -1e-3;
      for (int ms = 0; ms <= 4800; ++ms) {
        if (ms % 500 >= 100) z -= 0.5e-6;
        const double now = std::pow(std::max(0.0, surface - z), 1.5);
        growth.push_back(now - before);
        before = now;
        if (ms % 20 != 0) continue;
        double force = now;
        for (int past = 0; past <= ms; ++past)
          force += 1.5 * growth[static_cast<std::size_t>(past)] * std::exp(-(ms - past) / 500.0);
        search.add(1e-3 * ms, z, 0.02 + 1.5e3 * force + (noise > 0.0 ? scatter(generator) : 0.0));
      }
      const auto found = search.find();
      ASSERT_TRUE(found);
      worst = std::max(worst, std::abs(found->surface - surface));
      stated = std::max(stated, found->error);
    }
    // 2 um of the steps of 1 ms, and four standard deviations in 20 runs.
    EXPECT_LT(worst, 2e-6 + 4.0 * stated) << noise;
    EXPECT_LT(stated, 1e-6 + 0.06e-3 * noise / 10e-3) << noise;
  }
}

TEST(SurfaceSearch, FindsNothingWhereNothingIs) {
  const contact::Relaxation elastic;
  SurfaceSearch upwards(elastic);
  for (int i = 0; i < 50; ++i) upwards.add(0.02 * i, -1e-5 * i, -1e-3 * i);
  EXPECT_FALSE(upwards.find());
  SurfaceSearch still(elastic);
  for (int i = 0; i < 50; ++i) still.add(0.02 * i, 0.0, 0.1);
  EXPECT_FALSE(still.find());
  EXPECT_FALSE(SurfaceSearch(elastic).find());
}

TEST(StraightLine, KnowsNothingFromTooLittle) {
  StraightLine line;
  EXPECT_FALSE(line.found());
  line.add(-1e-3, 0.01);
  line.add(-2e-3, 0.02);
  EXPECT_FALSE(line.found()) << "two points are a line whatever they are";
  StraightLine upright;
  for (int i = 0; i < 5; ++i) upright.add(-1e-3, 0.01 * i);
  EXPECT_FALSE(upright.found());
  StraightLine level;
  for (int i = 0; i < 5; ++i) level.add(-1e-3 * i, 0.0);
  EXPECT_FALSE(level.found());
}

}  // namespace
}  // namespace palpate::live
