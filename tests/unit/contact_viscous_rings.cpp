// The rings of a viscoelastic surface: pressed and free as one state, and the stack that keeps
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "contact/viscous_contact.h"

namespace palpate::contact {
namespace {

constexpr double millimetre = 1e-3;

// What a ring holds when it is let go and when it is met again at once is the same.
TEST(ViscousRing, FreeAndPressedAreOneState) {
  ViscousRing ring({.branches = {{.time = 0.02, .ratio = 5.0},
                                 {.time = 0.2, .ratio = 1.0},
                                 {.time = 3.0, .ratio = 3.0}}});
  ASSERT_EQ(ring.mode_count(), 3u);
  // Pressed down by 1 mm and held for a second: q_k; then back until nothing pushes.
  std::vector<double> branches(3), modes(3), again(3);
  ring.press(1.0, millimetre, branches);
  EXPECT_DOUBLE_EQ(branches[0], 5.0 * millimetre);
  ring.set_time_step(1.0);
  ring.press(1.0, 0.0, branches);
  EXPECT_DOUBLE_EQ(branches[2], 3.0 * millimetre * std::exp(-1.0 / 3.0));
  ring.set_time_step(0.0);
  const double push = millimetre + branches[0] + branches[1] + branches[2];
  const double rise = push / 10.0;  // E_0 / E_inf
  ring.press(1.0, -rise, branches);
  ring.let_go(millimetre - rise, branches, modes);
  EXPECT_NEAR(modes[0] + modes[1] + modes[2], millimetre - rise, 1e-15 * millimetre);  // rounding
  ring.meet(modes, again);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(again[k], branches[k], 1e-14 * millimetre);
  // Free, it keeps q = 0 in a step of any length.
  ring.set_time_step(0.1);
  ring.rise(1.0, modes);
  ring.meet(modes, again);
  const double w = modes[0] + modes[1] + modes[2];
  EXPECT_NEAR(w + again[0] + again[1] + again[2], 0.0, 1e-14 * millimetre);
  // The branches follow  q_k' = b_k w' - q_k / tau_k  of that free rise: in the middle of a step.
  std::vector<double> before = modes, after = modes, q_before(3), q_after(3);
  ring.set_time_step(1e-5);
  ring.rise(1.0, after);
  ring.meet(before, q_before);
  ring.meet(after, q_after);
  const double sunk = after[0] + after[1] + after[2] - w;
  std::vector<double> pressed = q_before;
  ring.press(1.0, sunk, pressed);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(pressed[k] - q_before[k], q_after[k] - q_before[k],
                1e-9 * millimetre);  // dt^3 / tau^3
}

TEST(ViscousRing, PartsOfAStep) {
  ViscousRing ring({.branches = {{.time = 0.5, .ratio = 2.0}}});  // T = 1.5 s
  ring.set_time_step(0.1);
  for (const double part : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const double time = part * 0.1;
    // of the order of x^4/10 and x^3/10, x = 0.2, and nothing at either end
    const double slack = part * (1.0 - part) * 4e-4 + 1e-15;
    std::vector<double> branches{1.0}, modes{1.0};
    ring.press(part, 0.0, branches);
    EXPECT_NEAR(branches[0], std::exp(-time / 0.5), slack) << part;
    branches[0] = 0.0;
    ring.press(part, 1.0, branches);
    const double mean = part > 0.0 ? 2.0 * -std::expm1(-time / 0.5) / (time / 0.5) : 2.0;
    EXPECT_NEAR(branches[0], mean, 10.0 * slack) << part;
    ring.rise(part, modes);
    EXPECT_NEAR(modes[0], std::exp(-time / 1.5), slack) << part;
  }
}

TEST(FadingStack, FadesEveryRing) {
  FadingStack stack(2, 2, 8);
  const double halves[] = {0.5, 0.25};
  const double first[] = {1.0, 2.0, 3.0, 4.0};
  const double second[] = {5.0, 6.0, 7.0, 8.0};
  stack.push(1.0, 10.0, first);
  stack.fade(halves);
  stack.fade(halves);
  stack.push(2.0, 20.0, second);
  stack.fade(halves);
  EXPECT_EQ(stack.level(), 2.0);
  EXPECT_EQ(stack.level_below(), 1.0);
  EXPECT_EQ(stack.elastic_force_below(), 10.0);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_EQ(stack.value(j), second[j] * halves[j % 2]);
    EXPECT_EQ(stack.value_before(j), second[j]);
  }
  stack.pop();
  EXPECT_EQ(stack.level(), 1.0);
  EXPECT_EQ(stack.elastic_force(), 10.0);
  for (std::size_t j = 0; j < 4; ++j) {
    const double half = halves[j % 2];
    EXPECT_EQ(stack.value(j), first[j] * half * half * half);
    EXPECT_EQ(stack.value_before(j), first[j] * half * half);
  }
  stack.pop();
  EXPECT_TRUE(stack.empty());
}

TEST(FadingStack, DropsFromTheMiddleAndKeepsTheAges) {
  FadingStack stack(1, 1, 8);
  const double keep[] = {0.5};
  for (int i = 0; i < 9; ++i) {
    const double value[] = {1.0 + i};
    // Two far away, seven close together.
    stack.push(i < 2 ? i : 10.0 + 0.01 * i, i, value);
    stack.fade(keep);
  }
  ASSERT_LT(stack.size(), 8u);
  ASSERT_GE(stack.size(), 4u);
  double level = 1e9;
  while (!stack.empty()) {
    // Each still knows its force, its value and the steps since it came.
    const double i = stack.elastic_force();
    EXPECT_EQ(stack.value(0), (1.0 + i) * std::pow(0.5, 9.0 - i));
    EXPECT_LT(stack.level(), level);
    level = stack.level();
    stack.pop();
  }
  EXPECT_EQ(level, 0.0);
}

}  // namespace
}  // namespace palpate::contact
