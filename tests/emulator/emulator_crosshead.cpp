// The crosshead against the formulas of constant acceleration.
#include "emulator/stand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace emulator {
namespace {

constexpr double dt = 1.0 / 7000.0;  // s

Crosshead ready(double speed) {
  Crosshead head;
  head.speed = speed;
  return head;
}

void run(Crosshead& head, double time) {
  for (int i = 0; i < static_cast<int>(std::lround(time / dt)); ++i) step(head, dt);
}

TEST(EmulatorCrosshead, CruisesBehindItsAcceleration) {
  Crosshead head = ready(10e-3);
  send_off(head, -1);
  run(head, 0.5);
  const double a = head.settings.acceleration;
  // x = v t - v^2 / (2 a) once the speed is reached, and the corner lies within a step.
  EXPECT_NEAR(head.position, -(10e-3 * 0.5 - 10e-3 * 10e-3 / (2.0 * a)), a * dt * dt);
  EXPECT_NEAR(head.velocity, -10e-3, 1e-15);  // rounding
}

TEST(EmulatorCrosshead, StopsAfterItsBrakingWay) {
  Crosshead head = ready(15e-3);
  send_off(head, 1);
  run(head, 1.0);
  const double before = head.position;
  halt(head);
  run(head, 1.0);
  const double a = head.settings.acceleration;
  EXPECT_FALSE(moves(head));
  EXPECT_NEAR(head.position - before, 15e-3 * 15e-3 / (2.0 * a), a * dt * dt);
}

TEST(EmulatorCrosshead, ComesToRestAtItsLimitAndNeverBeyond) {
  for (const double speed : {0.01e-3, 1e-3, 5e-3, 18e-3}) {
    Crosshead head = ready(speed);
    head.mode = Mode::limit;
    head.lower_limit = -3e-3;
    send_off(head, -1);
    double lowest = 0.0;
    double fastest_change = 0.0;
    for (int i = 0; i < 7000 * 5 && moves(head); ++i) {
      const double before = head.velocity;
      step(head, dt);
      lowest = std::min(lowest, head.position);
      fastest_change = std::max(fastest_change, std::abs(head.velocity - before));
    }
    if (speed < 1e-3) continue;  // five seconds do not reach
    EXPECT_EQ(head.position, -3e-3) << speed;
    EXPECT_EQ(lowest, -3e-3) << speed;
    EXPECT_EQ(head.at_end, -1);
    // The last part of a step is cut off: two steps' worth at most.
    EXPECT_LE(fastest_change, 2.0 * head.settings.acceleration * dt) << speed;
    send_off(head, -1);
    EXPECT_FALSE(moves(head)) << "it stands at its limit";
    send_off(head, 1);
    EXPECT_TRUE(moves(head));
  }
}

TEST(EmulatorCrosshead, IgnoresLimitsInManualModeButNotTheSwitch) {
  Crosshead head = ready(18e-3);
  head.settings.lower_end = -20e-3;
  head.lower_limit = -3e-3;
  send_off(head, -1);
  run(head, 3.0);
  EXPECT_EQ(head.position, -20e-3);
  EXPECT_EQ(head.at_end, -1);
  EXPECT_FALSE(moves(head));
}

TEST(EmulatorCrosshead, DoesNotJumpWhenALimitIsSetBehindIt) {
  Crosshead head = ready(18e-3);
  head.mode = Mode::limit;
  send_off(head, -1);
  run(head, 0.5);
  const double here = head.position;
  head.lower_limit = here + 2e-3;
  run(head, 1.0);
  EXPECT_FALSE(moves(head));
  EXPECT_NEAR(head.position, here - 18e-3 * 18e-3 / (2.0 * head.settings.acceleration),
              18e-3 * dt);  // it brakes on from there
}

TEST(EmulatorCrosshead, CyclesBetweenItsLimits) {
  Crosshead head = ready(18e-3);
  head.mode = Mode::cycle;
  head.lower_limit = -2e-3;
  head.upper_limit = 0.0;
  head.cycles_set = 3;
  send_off(head, -1);
  run(head, 4.0);
  EXPECT_FALSE(moves(head));
  EXPECT_EQ(head.half_cycles, 6);
  EXPECT_EQ(head.position, 0.0);
}

}  // namespace
}  // namespace emulator
