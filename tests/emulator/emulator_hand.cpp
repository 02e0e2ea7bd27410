// The hand against the formulas of a damped oscillator and of minimum jerk.
#include "emulator/arm.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emulator {
namespace {

constexpr double step = 1.0 / 8000.0;  // s, the service's

HandSettings still(double damping) {
  return {.mass = 0.2, .stiffness = 300.0, .damping = damping, .start = {0.0, 0.0, 0.0}};
}

// y(t) after a constant force from rest, under, at and above critical damping.
double response(const HandSettings& s, double force, double t) {
  const double w = std::sqrt(s.stiffness / s.mass);
  const double d = s.damping / (2.0 * s.mass);
  const double rest = force / s.stiffness;
  if (d < w) {
    const double wd = std::sqrt(w * w - d * d);
    return rest * (1.0 - std::exp(-d * t) * (std::cos(wd * t) + d / wd * std::sin(wd * t)));
  }
  if (d == w) return rest * (1.0 - std::exp(-w * t) * (1.0 + w * t));
  const double r = std::sqrt(d * d - w * w);
  return rest * (1.0 - std::exp(-d * t) * (std::cosh(r * t) + d / r * std::sinh(r * t)));
}

TEST(EmulatorHand, AnswersAForceAsAnOscillatorDoes) {
  const double critical = 2.0 * std::sqrt(300.0 * 0.2);
  for (const double damping : {0.0, 4.0, critical, 60.0}) {
    Hand hand = make_hand(still(damping), step);
    for (int i = 1; i <= 4000; ++i) {
      move(hand, {0.0, 0.0, 1.5}, {});
      if (i % 500 != 0) continue;
      EXPECT_NEAR(hand.position[2], response(hand.settings, 1.5, i * step),
                  1e-14)  // rounding of 4000 exact steps, of 5 mm
          << damping << " N s/m, " << i * step << " s";
    }
    EXPECT_EQ(hand.position[0], 0.0);
  }
}

TEST(EmulatorHand, MeansToGoWithoutJerk) {
  HandSettings s = still(4.0);
  s.waypoints = {{0.8, {0.0, 0.0, -0.04}}, {1.2, {0.0, 0.0, -0.04}}, {2.0, {0.02, 0.0, 0.0}}};
  EXPECT_EQ(intent_at(s, 0.0).position[2], 0.0);
  EXPECT_NEAR(intent_at(s, 0.4).position[2], -0.02, 1e-15);                // halfway at half time
  EXPECT_NEAR(intent_at(s, 0.4).velocity[2], -1.875 * 0.04 / 0.8, 1e-15);  // Flash and Hogan
  EXPECT_NEAR(intent_at(s, 0.4).acceleration[2], 0.0, 1e-12);
  EXPECT_EQ(intent_at(s, 1.0).position[2], -0.04);
  EXPECT_EQ(intent_at(s, 1.0).velocity[2], 0.0);
  EXPECT_EQ(intent_at(s, 9.0).position[0], 0.02);
  for (const double t : {0.1, 0.33, 0.7, 1.5}) {  // derivatives, by central differences
    const double h = 1e-5;
    const Intent now = intent_at(s, t);
    const double slope =
        (intent_at(s, t + h).position[2] - intent_at(s, t - h).position[2]) / (2.0 * h);
    const double bend =
        (intent_at(s, t + h).velocity[2] - intent_at(s, t - h).velocity[2]) / (2.0 * h);
    EXPECT_NEAR(now.velocity[2], slope, 1e-8);  // h^2 times the jerk
    EXPECT_NEAR(now.acceleration[2], bend, 1e-6);
  }
}

TEST(EmulatorHand, FollowsItsIntentWithTheOscillatorsLag) {
  // Released from nothing, m y'' + b y' + k y = -m a(t), y its lag behind the intent: solved here
  // with steps a hundredth as long by another rule.
  HandSettings s = still(4.0);
  s.waypoints = {{0.5, {0.0, 0.0, -0.03}}};
  Hand hand = make_hand(s, step);
  double y = 0.0;
  double v = 0.0;
  const int finer = 100;
  const double h = step / finer;
  for (int i = 1; i <= 6000; ++i) {
    move(hand, {}, {});
    for (int j = 0; j < finer; ++j) {
      const double t = (i - 1) * step + (j + 0.5) * h;
      v += h * (-intent_at(s, t).acceleration[2] - (4.0 * v + 300.0 * y) / 0.2);
      y += h * v;
    }
  }
  const double lag = hand.position[2] - intent_at(s, 6000 * step).position[2];
  EXPECT_NEAR(lag, y, 1e-6 * 0.03);  // the finer rule is of first order: h w, of what is left
}

TEST(EmulatorHand, CountsTheDevicesWorkExactly) {
  // A linear spring that is rendered without delay gives back what it took.
  Hand hand = make_hand(still(0.0), step);
  hand.velocity = {0.0, 0.0, -0.1};
  const double before = energy_of(hand);
  EXPECT_DOUBLE_EQ(before, 0.5 * 0.2 * 0.01);
  move(hand, {0.0, 0.0, 2.0}, {});
  // No damping and one constant force: the energy changes by the force's work and nothing else.
  EXPECT_NEAR(energy_of(hand) - before, 2.0 * hand.position[2], 1e-15);
  EXPECT_NEAR(hand.work, 2.0 * hand.position[2], 1e-18);
  for (int i = 0; i < 1000; ++i) move(hand, {}, {});
  EXPECT_NEAR(energy_of(hand) - before, hand.work, 1e-14);  // rounding of a thousand steps
  move(hand, {}, {0.0, 0.0, 5.0});
  EXPECT_NEAR(hand.work, energy_of(hand) - before, 1.0) << "another force is not the device's";
  EXPECT_GT(std::abs(energy_of(hand) - before - hand.work), 1e-6);
}

TEST(EmulatorHand, AStiffWallThatComesLateFeedsIt) {
  // F = -K z from the sample before, held a millisecond: active, for K T / 2 is above the damping.
  const auto most_work = [](double stiffness, double damping) {
    Hand hand = make_hand(still(damping), step);
    hand.velocity = {0.0, 0.0, -0.05};
    for (int i = 0; i < 1000; ++i) {
      const double force = -stiffness * hand.position[2];
      for (int j = 0; j < 8; ++j) move(hand, {0.0, 0.0, force}, {});
    }
    return hand.most_energy / (0.5 * 0.2 * 0.05 * 0.05);
  };
  EXPECT_GT(most_work(4000.0, 0.5), 10.0);  // K T / 2 = 2 N s/m
  EXPECT_LT(most_work(4000.0, 8.0), 1.001);
}

TEST(EmulatorHand, StandsWhileItIsHeld) {
  Hand hand = make_hand(still(1.0), step);
  hand.velocity = {0.1, 0.0, 0.0};
  move(hand, {}, {});
  const Vec3 where = hand.position;
  for (int i = 0; i < 10; ++i) hold(hand);
  EXPECT_EQ(hand.position, where);
  EXPECT_EQ(hand.velocity, Vec3{});
}

}  // namespace
}  // namespace emulator
