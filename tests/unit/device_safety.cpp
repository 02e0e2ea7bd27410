// Each safety rule by itself, stepped through explicit times.
#include "device/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::device {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Arming, IsOnlyExplicitAndNeverComesBack) {
  Arming arming;
  EXPECT_FALSE(arming.armed());
  EXPECT_TRUE(arming.arm());
  EXPECT_TRUE(arming.armed());
  arming.trip(Trip::link_lost);
  EXPECT_FALSE(arming.armed());
  EXPECT_FALSE(arming.arm());
  EXPECT_FALSE(arming.armed());
  arming.trip(Trip::by_hand);
  EXPECT_EQ(arming.tripped(), Trip::link_lost);  // the first reason stays
}

TEST(Force, IsZeroWhereItIsNoNumber) {
  EXPECT_EQ(finite_or_zero({1.0, 2.0, 3.0}), Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(finite_or_zero({1.0, not_a_number, 3.0}), Vec3::Zero());
  EXPECT_EQ(finite_or_zero({infinite, 0.0, 0.0}), Vec3::Zero());
}

TEST(Force, IsClampedAsAVector) {
  EXPECT_EQ(clamped_norm({1.0, 1.0, 1.0}, 2.0), Vec3(1.0, 1.0, 1.0));
  const Vec3 cut = clamped_norm({30.0, 40.0, 0.0}, 2.0);
  EXPECT_NEAR(cut.norm(), 2.0, 1e-15);  // rounding
  EXPECT_NEAR(cut.x() / cut.y(), 0.75, 1e-15);
  // Each axis would be allowed alone; the vector is not.
  EXPECT_NEAR(clamped_norm({1.9, 1.9, 1.9}, 2.0).norm(), 2.0, 1e-15);
  const double largest = std::numeric_limits<double>::max();
  EXPECT_NEAR(clamped_norm({largest, largest, 0.0}, 2.0).norm(), 2.0, 1e-15);
  EXPECT_EQ(clamped_norm(Vec3::Zero(), 2.0), Vec3::Zero());
}

TEST(Slew, IsLimitedAsAVectorAndReachesItsGoalExactly) {
  SlewLimit slew;
  const Vec3 goal(0.03, 0.04, 0.0);
  EXPECT_NEAR(slew.step(goal, 1e-3, 20.0).norm(), 0.02, 1e-15);
  EXPECT_NEAR(slew.step(goal, 1e-3, 20.0).norm(), 0.04, 1e-15);
  EXPECT_EQ(slew.step(goal, 1e-3, 20.0), goal);
  EXPECT_NEAR((slew.step(-goal, 1e-3, 20.0) - goal).norm(), 0.02, 1e-15);
  EXPECT_EQ(slew.step(Vec3::Zero(), 1.0, 20.0), Vec3::Zero());
  EXPECT_EQ(slew.step(goal, 0.0, 20.0), Vec3::Zero());   // no time, no change
  EXPECT_EQ(slew.step(goal, -1.0, 20.0), Vec3::Zero());  // nor where time goes back
}

TEST(Start, RampsFromZeroAndNotInsideTissue) {
  StartRamp ramp(0.5);
  EXPECT_EQ(ramp.gain(100.0), 0.0);
  EXPECT_FALSE(ramp.start(10.0, 1e-6));
  EXPECT_FALSE(ramp.start(10.0, not_a_number));
  EXPECT_EQ(ramp.gain(11.0), 0.0);
  EXPECT_TRUE(ramp.start(10.0, 0.0));
  EXPECT_EQ(ramp.gain(10.0), 0.0);
  EXPECT_DOUBLE_EQ(ramp.gain(10.25), 0.5);
  EXPECT_EQ(ramp.gain(10.5), 1.0);
  EXPECT_EQ(ramp.gain(9.0), 0.0);
}

constexpr StaleRule rule{.stale_after = 3e-3, .lost_after = 0.1, .fall = 0.05, .rise = 0.5};

TEST(Stale, FallsToZeroIn50Ms) {
  Staleness stale(rule);
  double now = 1.0;
  for (int i = 0; i < 10; ++i) stale.step(now += 1e-3, Arrival::fresh);
  EXPECT_EQ(stale.gain(), 1.0);
  const double last = now;
  while (now - last < 3.5e-3) {
    EXPECT_EQ(stale.gain(), 1.0);
    stale.step(now += 1e-3, Arrival::none);
  }
  EXPECT_EQ(stale.state(), Staleness::State::stale);
  const double begin = now;
  while (now - begin < 0.0495) stale.step(now += 1e-3, Arrival::duplicate);
  EXPECT_NEAR(stale.gain(), 0.0, 1e-9);  // rounding of 50 steps
  EXPECT_EQ(stale.state(), Staleness::State::stale);
}

TEST(Stale, ComesBackSlowly) {
  Staleness stale(rule);
  double now = 0.0;
  stale.step(now, Arrival::fresh);
  for (int i = 0; i < 60; ++i) stale.step(now += 1e-3, Arrival::dropped);
  EXPECT_EQ(stale.gain(), 0.0);
  stale.step(now += 1e-3, Arrival::fresh);
  EXPECT_EQ(stale.state(), Staleness::State::fresh);
  for (int i = 0; i < 249; ++i) stale.step(now += 1e-3, Arrival::fresh);
  EXPECT_NEAR(stale.gain(), 0.5, 1e-9);  // 250 ms of 500 ms
}

TEST(Stale, IsLostAfterItsTimeForGood) {
  Staleness stale(rule);
  double now = 0.0;
  stale.step(now, Arrival::fresh);
  for (int i = 0; i < 99; ++i) stale.step(now += 1e-3, Arrival::none);
  EXPECT_EQ(stale.state(), Staleness::State::stale);
  stale.step(now += 2e-3, Arrival::none);
  EXPECT_EQ(stale.state(), Staleness::State::lost);
  for (int i = 0; i < 1000; ++i) stale.step(now += 1e-3, Arrival::fresh);
  EXPECT_EQ(stale.state(), Staleness::State::lost);
  EXPECT_EQ(stale.gain(), 0.0);
}

TEST(Stale, IsLostByOneLongFrameEvenIfItEndsWithASample) {
  Staleness stale(rule);
  stale.step(0.0, Arrival::fresh);
  stale.step(0.2, Arrival::fresh);
  EXPECT_EQ(stale.state(), Staleness::State::lost);
}

TEST(Stale, IsLostAtOnceWhereTheLinkSaysSo) {
  Staleness stale(rule);
  stale.step(0.0, Arrival::fresh);
  stale.step(1e-3, Arrival::lost);
  EXPECT_EQ(stale.state(), Staleness::State::lost);
}

TEST(WorkspaceBox, HoldsWhatIsInside) {
  const Workspace box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  EXPECT_TRUE(box.holds({0.0, 1.0, -1.0}));
  EXPECT_FALSE(box.holds({0.0, 0.0, 1.001}));
  EXPECT_FALSE(box.holds({0.0, not_a_number, 0.0}));
  EXPECT_TRUE(Workspace{}.holds({1e6, 0.0, 0.0}));
}

TEST(Jump, IsDroppedUntilTheDeviceCanHaveGotThere) {
  JumpCheck jump(1.0, 1e-3);
  EXPECT_TRUE(jump.takes(0.0, {5.0, 0.0, 0.0}));  // the first is where it is
  EXPECT_TRUE(jump.takes(1e-3, {5.001, 0.0, 0.0}));
  EXPECT_FALSE(jump.takes(2e-3, {5.05, 0.0, 0.0}));
  EXPECT_FALSE(jump.takes(3e-3, {not_a_number, 0.0, 0.0}));
  EXPECT_TRUE(jump.takes(3e-3, {5.002, 0.0, 0.0}));  // back where it was
  EXPECT_TRUE(jump.takes(0.103, {5.1, 0.0, 0.0}));   // 0.1 m in 0.1 s
}

Sample at(double z, double force) {
  Sample sample;
  sample.arrival = Arrival::fresh;
  sample.position = Vec3(0.0, 0.0, z);
  sample.force = force;
  return sample;
}

constexpr StandRules stand_rules{.force = 5.0, .low = -10e-3, .high = 10e-3};
using Verdict = StandSafety::Verdict;
constexpr Motion down{Motion::Act::down, 1e-3};
constexpr Motion up{Motion::Act::up, 1e-3};

TEST(Stand, IsArmedOnlyWithLimitsInTheDeviceAndAFreshSample) {
  StandSafety stand(stand_rules);
  EXPECT_FALSE(stand.arm(Fault::none));
  EXPECT_EQ(stand.step(0.0, at(0.0, 0.0)), Verdict::go_on);
  EXPECT_FALSE(stand.arm(Fault::not_verified));
  EXPECT_EQ(stand.allow(down).act, Motion::Act::stop);
  EXPECT_TRUE(stand.arm(Fault::none));
  EXPECT_EQ(stand.allow(down).act, Motion::Act::down);
  stand.disarm();
  EXPECT_EQ(stand.allow(down).act, Motion::Act::stop);
  EXPECT_FALSE(stand.arm(Fault::none));
}

TEST(Stand, IsNotArmedOutsideItsLimits) {
  StandSafety stand(stand_rules);
  static_cast<void>(stand.step(0.0, at(-10.05e-3, 0.0)));
  EXPECT_FALSE(stand.arm(Fault::none));
}

TEST(Stand, StopsForGoodAtItsForceCeilingWhateverTheSign) {
  for (const double force : {5.1, -5.1}) {
    StandSafety stand(stand_rules);
    EXPECT_EQ(stand.step(0.0, at(0.0, 0.0)), Verdict::go_on);
    ASSERT_TRUE(stand.arm(Fault::none));
    EXPECT_EQ(stand.step(0.02, at(0.0, 4.9)), Verdict::go_on);
    EXPECT_EQ(stand.step(0.04, at(0.0, force)), Verdict::stop);
    EXPECT_EQ(stand.step(0.06, at(0.0, 0.0)), Verdict::stop);
    EXPECT_EQ(stand.tripped(), Trip::force_ceiling);
    EXPECT_EQ(stand.allow(down).act, Motion::Act::stop);
  }
}

TEST(Stand, StopsBeyondItsTravelAndAtAnOverload) {
  for (const double end : {-1.0, 1.0}) {
    StandSafety beyond(stand_rules);
    EXPECT_EQ(beyond.step(0.0, at(10.05e-3 * end, 0.0)), Verdict::go_on);  // until it stands still
    EXPECT_EQ(beyond.step(0.02, at(10.2e-3 * end, 0.0)), Verdict::stop);
    EXPECT_EQ(beyond.tripped(), Trip::travel);
  }
  StandSafety overloaded(stand_rules);
  Sample sample;
  sample.arrival = Arrival::dropped;
  sample.fault = Fault::overload;
  EXPECT_EQ(overloaded.step(0.0, sample), Verdict::stop);
  EXPECT_EQ(overloaded.tripped(), Trip::overload);
}

TEST(Stand, DropsAJumpAndStopsWhereItStays) {
  StandSafety stand(stand_rules);
  EXPECT_EQ(stand.step(0.0, at(5e-3, 0.0)), Verdict::go_on);
  ASSERT_TRUE(stand.arm(Fault::none));
  EXPECT_EQ(stand.step(0.02, at(-5e-3, 0.0)), Verdict::go_on);  // a digit was lost
  EXPECT_EQ(stand.step(0.04, at(4.9e-3, 0.0)), Verdict::go_on);
  EXPECT_EQ(stand.step(0.06, at(0.0, 0.0)), Verdict::go_on);
  EXPECT_EQ(stand.step(0.08, at(0.0, 0.0)), Verdict::stop);  // its zero is another one
  EXPECT_EQ(stand.tripped(), Trip::jump);
  // At its fastest it goes 0.4 mm in a period, which is no jump.
  StandSafety moving(stand_rules);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(moving.step(0.02 * i, at(-0.37e-3 * i, 0.0)), Verdict::go_on);
}

TEST(Stand, MovesAwayFromALimitOnly) {
  StandSafety stand(stand_rules);
  static_cast<void>(stand.step(0.0, at(-10e-3, 0.0)));
  ASSERT_TRUE(stand.arm(Fault::none));
  EXPECT_EQ(stand.allow(down).act, Motion::Act::stop);
  EXPECT_EQ(stand.allow(up).act, Motion::Act::up);
  EXPECT_EQ(stand.allow({Motion::Act::up, 1.0}).speed, stand_rules.fastest);
  EXPECT_EQ(stand.allow({Motion::Act::up, not_a_number}).act, Motion::Act::stop);
  EXPECT_EQ(stand.allow({Motion::Act::up, -1.0}).act, Motion::Act::stop);
  StandSafety above(stand_rules);
  static_cast<void>(above.step(0.0, at(10e-3, 0.0)));
  ASSERT_TRUE(above.arm(Fault::none));
  EXPECT_EQ(above.allow(up).act, Motion::Act::stop);
  EXPECT_EQ(above.allow(down).act, Motion::Act::down);
}

TEST(Stand, HaltsWhileSamplesAreMissingAndStopsWhenTheyStayAway) {
  StandSafety stand(stand_rules);
  double now = 0.0;
  static_cast<void>(stand.step(now, at(0.0, 0.0)));
  ASSERT_TRUE(stand.arm(Fault::none));
  const Sample none;
  EXPECT_EQ(stand.step(now = 0.05, none), Verdict::go_on);
  EXPECT_EQ(stand.step(now = 0.07, none), Verdict::halt);
  EXPECT_EQ(stand.allow(down).act, Motion::Act::stop);
  EXPECT_EQ(stand.step(now = 0.08, at(0.0, 0.0)), Verdict::go_on);
  EXPECT_EQ(stand.allow(down).act, Motion::Act::down);
  EXPECT_EQ(stand.step(now = 0.32, none), Verdict::halt);
  EXPECT_EQ(stand.step(now = 0.34, none), Verdict::stop);
  EXPECT_EQ(stand.tripped(), Trip::link_lost);
  EXPECT_EQ(stand.step(now = 0.36, at(0.0, 0.0)), Verdict::stop);
}

TEST(Stand, TakesAForceThatIsNoNumberForASampleThatIsMissing) {
  StandSafety stand(stand_rules);
  static_cast<void>(stand.step(0.0, at(0.0, 0.0)));
  EXPECT_EQ(stand.step(0.07, at(0.0, not_a_number)), Verdict::halt);
}

}  // namespace
}  // namespace palpate::device
