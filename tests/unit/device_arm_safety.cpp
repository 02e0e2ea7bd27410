// The rules of an arm together: whatever comes in and is asked for, what goes out is bounded.
#include "device/safety.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace palpate::device {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double frame = 1e-3;

Sample at(const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Sample sample;
  sample.arrival = Arrival::fresh;
  sample.position = position;
  sample.velocity = velocity;
  return sample;
}

// An arm at rest, armed, whose start ramp is over.
struct Ready {
  ArmSafety safety;
  double now = 0.0;

  explicit Ready(const ArmRules& rules) : safety(rules) {
    safety.take(now, at(Vec3::Zero()));
    EXPECT_TRUE(safety.arm(now, -1e-3));
    for (int i = 0; i < 600; ++i) step(at(Vec3::Zero()), Vec3::Zero());
  }
  Vec3 step(const Sample& sample, const Vec3& wanted) {
    now += frame;
    safety.take(now, sample);
    return safety.allow(now, wanted);
  }
};

TEST(Arm, SendsNothingBeforeItIsArmed) {
  ArmSafety safety{ArmRules{}};
  EXPECT_FALSE(safety.arm(0.0, -1.0));  // no sample yet
  safety.take(0.0, at(Vec3::Zero()));
  EXPECT_EQ(safety.allow(0.0, {0.0, 0.0, 1.0}), Vec3::Zero());
  safety.take(frame, at(Vec3::Zero()));
  EXPECT_EQ(safety.allow(frame, {0.0, 0.0, 1.0}), Vec3::Zero());
  EXPECT_FALSE(safety.arm(frame, 1e-3));  // inside the tissue
  EXPECT_EQ(safety.tripped(), Trip::none);
  EXPECT_TRUE(safety.arm(frame, 0.0));
}

TEST(Arm, RampsUpOverHalfASecond) {
  ArmSafety safety{ArmRules{}};
  safety.take(0.0, at(Vec3::Zero()));
  ASSERT_TRUE(safety.arm(0.0, 0.0));
  double force = 0.0;
  for (int i = 0; i <= 250; ++i) {
    safety.take(i * frame, at(Vec3::Zero()));
    force = safety.allow(i * frame, {0.0, 0.0, 1.0}).z();
    EXPECT_LE(force, i * frame / 0.5 + 1e-12);  // rounding
  }
  EXPECT_NEAR(force, 0.5, 1e-12);
}

// A share of what is allowed, and not of what is asked for.
TEST(Arm, RampsUpFromBelowItsForceWhateverIsAskedFor) {
  ArmRules rules;
  rules.slew = 1e6;
  ArmSafety safety{rules};
  safety.take(0.0, at(Vec3::Zero()));
  ASSERT_TRUE(safety.arm(0.0, 0.0));
  for (int i = 0; i <= 250; ++i) {
    safety.take(i * frame, at(Vec3::Zero()));
    const double force = safety.allow(i * frame, {0.0, 0.0, 1e3 * rules.force}).z();
    EXPECT_LE(force, i * frame / 0.5 * rules.force + 1e-12);  // rounding
  }
}

TEST(Arm, ClampsTheNormAndTheChange) {
  Ready ready{ArmRules{}};
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 100; ++i) {
    const Vec3 force = ready.step(at(Vec3::Zero()), {30.0, -40.0, 0.0});
    EXPECT_LE(force.norm(), 2.0 + 1e-12);
    EXPECT_LE((force - before).norm(), 50.0 * frame + 1e-12);
    before = force;
  }
  EXPECT_NEAR(before.norm(), 2.0, 1e-12);
  EXPECT_EQ(ready.safety.counts().clamped, 100u);
  EXPECT_EQ(ready.safety.counts().slewed, 39u);  // 2 N at 0.05 N a frame: 40 frames, the last whole
}

// A hand that was pulled along and turns back is braked in the direction of the force itself.
TEST(Arm, ClampsWhatTheControllerAdds) {
  Ready ready{ArmRules{}};
  double x = 0.0;
  double most = 0.0;
  for (int i = 0; i < 140; ++i) {
    const double v = i < 100 ? 0.5 : -0.5;
    x += v * frame;
    most = std::max(most, ready.step(at({x, 0.0, 0.0}, {v, 0.0, 0.0}), {2.0, 0.0, 0.0}).norm());
  }
  EXPECT_GT(ready.safety.counts().damped, 100u);
  EXPECT_LT(ready.safety.observer().energy(), 0.0);
  EXPECT_NEAR(most, 2.0, 1e-12);  // rounding
}

TEST(Arm, NeverSendsWhatIsNoNumber) {
  Ready ready{ArmRules{}};
  for (int i = 0; i < 50; ++i) ready.step(at(Vec3::Zero()), {1.0, 0.0, 0.0});
  Vec3 force = Vec3::Zero();
  for (const double bad : {nan, INFINITY * 1.0, -INFINITY * 1.0})
    for (int i = 0; i < 10; ++i) {
      force = ready.step(at(Vec3::Zero()), {bad, 1.0, 1.0});
      EXPECT_TRUE(force.allFinite());
    }
  EXPECT_EQ(force, Vec3::Zero());  // 1 N at 50 N/s
  EXPECT_EQ(ready.safety.counts().not_finite, 30u);
  // A position that is none is no sample.
  EXPECT_FALSE(ready.safety.take(ready.now, at({nan, 0.0, 0.0})));
  EXPECT_FALSE(ready.safety.take(ready.now, at(Vec3::Zero(), {nan, 0.0, 0.0})));
}

TEST(Arm, FallsToZeroWhenSamplesAreMissingAndTripsWhenTheyStayAway) {
  ArmRules rules;
  rules.force = 8.0;  // its slew alone would take 160 ms
  Ready ready{rules};
  for (int i = 0; i < 300; ++i) ready.step(at(Vec3::Zero()), {0.0, 0.0, 8.0});
  const double last = ready.now;
  const Sample none;
  while (ready.now - last < 0.0545) ready.step(none, {0.0, 0.0, 8.0});
  EXPECT_LT(ready.safety.sent().norm(), 1e-9);  // 3 ms until stale, then 50 ms
  EXPECT_TRUE(ready.safety.armed());
  while (ready.now - last < 0.1005) ready.step(none, {0.0, 0.0, 8.0});
  EXPECT_EQ(ready.safety.tripped(), Trip::link_lost);
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(ready.step(at(Vec3::Zero()), {0.0, 0.0, 8.0}), Vec3::Zero());
  EXPECT_FALSE(ready.safety.arm(ready.now, -1.0));
}

TEST(Arm, IsSilentAtOnceWhenTheLinkIsLost) {
  Ready ready{ArmRules{}};
  for (int i = 0; i < 100; ++i) ready.step(at(Vec3::Zero()), {0.0, 0.0, 2.0});
  Sample lost;
  lost.arrival = Arrival::lost;
  EXPECT_EQ(ready.step(lost, {0.0, 0.0, 2.0}), Vec3::Zero());
}

TEST(Arm, ObeysTheDevicesOwnBrake) {
  for (const Fault fault : {Fault::brake, Fault::stalled, Fault::unstable}) {
    Ready ready{ArmRules{}};
    for (int i = 0; i < 100; ++i) ready.step(at(Vec3::Zero()), {0.0, 0.0, 2.0});
    Sample braked = at(Vec3::Zero());
    braked.fault = fault;
    for (int i = 0; i < 50; ++i) ready.step(braked, {0.0, 0.0, 2.0});
    EXPECT_EQ(ready.safety.tripped(), Trip::brake);
    EXPECT_EQ(ready.safety.sent(), Vec3::Zero());
  }
}

TEST(Arm, RendersNothingOutsideItsWorkspaceOrForAFastHand) {
  ArmRules rules;
  rules.workspace = {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
  Ready ready{rules};
  Vec3 where = Vec3::Zero();
  for (int i = 0; i < 200; ++i) ready.step(at(where), {0.0, 0.0, 1.0});
  EXPECT_EQ(ready.safety.sent().z(), 1.0);
  while (where.z() <= 0.1) ready.step(at(where += Vec3(0.0, 0.0, 1e-3)), {0.0, 0.0, 1.0});
  for (int i = 0; i < 50; ++i) ready.step(at(where), {0.0, 0.0, 1.0});
  EXPECT_EQ(ready.safety.sent(), Vec3::Zero());
  EXPECT_GT(ready.safety.counts().outside, 0u);
  where.setZero();
  ready.now += 0.05;
  for (int i = 0; i < 200; ++i) ready.step(at(where), {0.0, 0.0, 1.0});
  EXPECT_GT(ready.safety.sent().z(), 0.0);
  for (int i = 0; i < 50; ++i) ready.step(at(where, {0.0, 1.5, 0.0}), {0.0, 0.0, 1.0});
  EXPECT_EQ(ready.safety.sent(), Vec3::Zero());
  EXPECT_EQ(ready.safety.counts().too_fast, 50u);
}

TEST(Arm, DropsJumps) {
  Ready ready{ArmRules{}};
  EXPECT_FALSE(ready.safety.take(ready.now + frame, at({0.05, 0.0, 0.0})));
  EXPECT_EQ(ready.safety.counts().jumps, 1u);
  EXPECT_TRUE(ready.safety.take(ready.now + frame, at({1e-4, 0.0, 0.0})));
}

// Whatever comes, the force that goes out is finite, below its ceiling, and its change is bounded.
TEST(Arm, KeepsItsBoundsUnderAnything) {
  std::mt19937_64 random(7);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
  const auto odd = [&](double scale) {
    switch (random() % 12) {
      case 0: return nan;
      case 1: return 1e308;
      case 2: return static_cast<double>(-INFINITY);
      default: return scale * uniform();
    }
  };
  for (int session = 0; session < 50; ++session) {
    const ArmRules rules;
    ArmSafety safety(rules);
    double now = 0.0;
    Vec3 before = Vec3::Zero();
    for (int i = 0; i < 400; ++i) {
      now += 1e-3 * static_cast<double>(random() % 4);
      Sample sample = at({odd(0.01), odd(0.01), odd(0.01)}, {odd(0.5), odd(0.5), odd(0.5)});
      sample.arrival = static_cast<Arrival>(random() % 4);
      safety.take(now, sample);
      if (i % 50 == 10) safety.arm(now, -1.0);
      const double last = now;
      const Vec3 force = safety.allow(now, {odd(3.0), odd(3.0), odd(3.0)});
      ASSERT_TRUE(force.allFinite());
      ASSERT_LE(force.norm(), rules.force * (1.0 + 1e-12));
      if (safety.freshness() != Staleness::State::lost) {
        ASSERT_LE((force - before).norm(), 50.0 * 4e-3 + 1e-12) << last;
      }
      before = force;
    }
  }
}

// A hand against a wall that is stiffer than the frame allows: x'' = (F - b v)/m, held forces.
double hands_gain(double stiffness, ArmRules::Passivity passivity) {
  ArmRules rules;
  rules.passivity = passivity;
  rules.force = 20.0;
  rules.slew = 1e6;
  rules.damping = 4.0;
  ArmSafety safety(rules);
  constexpr double mass = 0.3;     // kg, of arm and fingers
  constexpr double damping = 0.1;  // N s/m, of the arm alone
  double x = 1e-3;
  double v = 0.0;
  double now = 0.0;
  safety.take(now, at({0.0, 0.0, x}));
  EXPECT_TRUE(safety.arm(now, 0.0));
  for (; now < 0.6; now += frame) {
    safety.take(now, at({0.0, 0.0, x}));
    static_cast<void>(safety.allow(now, Vec3::Zero()));
  }
  v = -0.05;  // m/s, towards the wall at 0
  const double given = 0.5 * mass * v * v;
  double most = 0.0;
  for (int i = 0; i < 1500; ++i, now += frame) {
    safety.take(now, at({0.0, 0.0, x}, {0.0, 0.0, v}));
    const double force = safety.allow(now, {0.0, 0.0, x < 0.0 ? -stiffness * x : 0.0}).z();
    for (int part = 0; part < 100; ++part) {  // finer than the frame
      v += (force - damping * v) / mass * (frame / 100);
      x += v * (frame / 100);
    }
    // A second wall, elastic, brings the hand back.
    if (x > 2e-3 && v > 0.0) v = -v;
    most = std::max(most, 0.5 * mass * v * v / given);
  }
  return most;
}

TEST(Arm, KeepsAStiffWallFromFeedingTheHand) {
  using Passivity = ArmRules::Passivity;
  // b > K T / 2: 0.1 N s/m allows 200 N/m at 1 ms.
  EXPECT_LT(hands_gain(150.0, Passivity::observe), 1.0 + 1e-6);
  EXPECT_GT(hands_gain(3000.0, Passivity::observe), 2.0);
  // A frame's energy at most escapes before the controller sees it.
  EXPECT_LT(hands_gain(3000.0, Passivity::control), 1.3);
}

TEST(Passivity, ObserverTellsEnergyOfAForceThatIsHeld) {
  PassivityObserver observer;
  observer.step(Vec3::Zero(), {9.0, 9.0, 9.0});  // the first position moves nothing
  EXPECT_EQ(observer.energy(), 0.0);
  observer.step({0.0, 0.0, -2e-3}, {0.0, 0.0, 1.0});  // the hand presses against 1 N
  EXPECT_DOUBLE_EQ(observer.energy(), 2e-3);
  observer.step({0.0, 0.0, 1e-3}, {0.0, 0.0, 1.0});
  EXPECT_DOUBLE_EQ(observer.energy(), -1e-3);
  observer.step({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  EXPECT_NEAR(observer.energy(), 0.0, 1e-18);
  EXPECT_DOUBLE_EQ(observer.least(), -1e-3);
}

TEST(Passivity, ControllerTakesTheDeficitOutAndNoMore) {
  PassivityObserver observer;
  observer.step(Vec3::Zero(), Vec3::Zero());
  observer.step({0.0, 0.0, 1e-3}, {0.0, 0.0, 0.01});  // 10 uJ into the hand
  PassivityController controller(5.0);
  const Vec3 velocity(0.0, 0.0, 0.1);
  const Vec3 force = controller.step(observer, velocity, 1e-3);
  EXPECT_NEAR(force.dot(velocity) * 1e-3, -1e-5, 1e-18);  // rounding
  EXPECT_DOUBLE_EQ(controller.damping(), 1.0);
  PassivityController weak(0.5);
  EXPECT_DOUBLE_EQ(weak.step(observer, velocity, 1e-3).z(), -0.05);
  EXPECT_EQ(controller.step(observer, Vec3::Zero(), 1e-3), Vec3::Zero());
  observer.step({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  EXPECT_EQ(controller.step(observer, velocity, 1e-3), Vec3::Zero());
  EXPECT_EQ(controller.damping(), 0.0);
}

TEST(Passivity, SurplusIsForgottenOutOfContactAndADebtIsNot) {
  PassivityObserver observer;
  observer.step(Vec3::Zero(), Vec3::Zero());
  observer.step({0.0, 0.0, -1e-3}, {0.0, 0.0, 1.0});
  observer.forget_surplus();
  EXPECT_EQ(observer.energy(), 0.0);
  observer.step({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  observer.forget_surplus();
  EXPECT_DOUBLE_EQ(observer.energy(), -1e-3);
}

}  // namespace
}  // namespace palpate::device
