// Presses of cases that an independent program computed (cases lump_none and lump_a), curves and
// slides.
#include "solid/finger_press.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/elliptic.h"
#include "contact/hertz.h"

namespace palpate::solid {
namespace {

void touch(FingerOrder& order, const Vec3& touched) {
  order.touch = {touched + order.radius * Vec3::UnitZ(), touched};
}

// Case lump_none: mN, kPa and mm of the scene as SI.
FingerOrder plain() {
  FingerOrder order;
  order.body.shape = geometry::Cuboid{Vec3(0.048, 0.044, 0.024)};
  order.body.tissues = {{16.3e3, 0.44}};
  order.body.mirrored = {true, true};
  order.radius = 7.9e-3;
  order.deepest = 0.83e-3;
  touch(order, Vec3(0.024, 0.022, 0.024));
  return order;
}

// Case lump_a: a stiff ball in it.
FingerOrder with_lump() {
  FingerOrder order = plain();
  order.body.tissues.push_back({200.49e3, 0.44});
  order.body.inclusions = {
      {.region = 1, .sphere = geometry::Inclusion{Vec3(0.0283, 0.022, 0.0161), 4.6e-3, 1}}};
  return order;
}

TEST(FingerPress, HasTheForcesAndTheContrastOfTheWitness) {
  FingerPress without(plain());
  FingerPress with(with_lump());
  const auto low = without.at_travel(0.83e-3);
  const auto high = with.at_travel(0.83e-3);
  ASSERT_TRUE(low && high);
  EXPECT_NEAR(low->force, 62.359e-3, 0.03 * 62.359e-3);   // lump_none, what one mesh states
  EXPECT_NEAR(high->force, 73.049e-3, 0.03 * 73.049e-3);  // lump_a
  EXPECT_NEAR(high->force / low->force, 73.049 / 62.359, 0.015);
  EXPECT_EQ(without.press().body().copies, 4);
  EXPECT_EQ(with.press().body().copies, 2);
}

TEST(FingerPress, IsOneCurveWhateverIsAskedFirst) {
  FingerPress up(plain());
  FingerPress down(plain());
  const std::vector<double> travels{0.05e-3, 0.2e-3, 0.4e-3, 0.6e-3, 0.83e-3};
  std::vector<double> forces;
  for (const double travel : travels) forces.push_back(up.at_travel(travel)->force);
  for (std::size_t i = travels.size(); i-- > 0;)
    EXPECT_EQ(down.at_travel(travels[i])->force, forces[i]);
  for (std::size_t i = 1; i < travels.size(); ++i) {
    const double power =
        std::log(forces[i] / forces[i - 1]) / std::log(travels[i] / travels[i - 1]);
    EXPECT_GT(power, 1.4);
    EXPECT_LT(power, 1.75);  // the base stiffens
  }
  EXPECT_EQ(up.at_travel(0.0)->force, 0.0);
}

// A layer that folds at nine tenths of this travel keeps the force up to there.
TEST(FingerPress, KeepsWhatItFoundWhereTheTissueFolds) {
  FingerOrder order;
  order.body.shape = geometry::Cuboid{Vec3(0.04, 0.04, 0.005)};
  order.body.tissues = {{10e3, 0.45}};
  order.body.mirrored = {true, true};
  order.radius = 10e-3;
  order.deepest = 4e-3;
  touch(order, Vec3(0.02, 0.02, 0.005));
  FingerPress folds(order);
  EXPECT_FALSE(folds.at_travel(4e-3));
  EXPECT_NE(folds.reason().find("no equilibrium beyond a displacement of 3.6"), std::string::npos)
      << folds.reason();
  order.deepest = 3e-3;
  FingerPress holds(order);
  for (const double travel : {1e-3, 2e-3, 3e-3}) {
    const auto kept = folds.at_travel(travel);
    const auto found = holds.at_travel(travel);
    ASSERT_TRUE(kept && found);
    EXPECT_NEAR(kept->force, found->force, 0.02 * found->force);  // two meshes
  }
}

// An elastic finger as stiff as the tissue, of one radius: Hertz's force, less by the ball's size.
TEST(FingerPress, AnElasticFingerIsABallOfItsOwnSize) {
  FingerOrder order = plain();
  order.body.shape = geometry::Cuboid{Vec3(0.0753, 0.0604, 0.0183)};
  order.body.tissues = {{2050e3, 0.45}};
  order.ball = tissue::Isotropic{2050e3, 0.4995};
  order.share = (1.0 - 0.45 * 0.45) / (1.0 - 0.45 * 0.45 + 0.75);
  order.radius = 9.7e-3;
  order.deepest = 0.61e-3;
  touch(order, Vec3(0.03765, 0.0302, 0.0183));
  FingerPress press(order);
  const auto found = press.at_travel(0.61e-3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->force, 2965.6e-3, 0.03 * 2965.6e-3);  // finger_2050_061
}

// Of four elastic spheres every ball bears a quarter of the force, and yields by its share of
// Hertz's depth under it. A quarter of the body is meshed, which only one of the spheres is above.
TEST(FingerPress, SeveralElasticSpheresShareTheForce) {
  FingerOrder order = plain();
  order.radius = 4e-3;
  order.centres.clear();
  for (const double x : {-5e-3, 5e-3})
    for (const double y : {-5e-3, 5e-3}) order.centres.emplace_back(x, y, 0.0);
  touch(order, Vec3(0.024, 0.022, 0.024));
  const geometry::SmoothSurface outer_surface(
      geometry::sampled(*order.body.shape, {0.004, 0.004}).parts.front().surface);
  order.outer_surface = &outer_surface;
  order.ball = tissue::Isotropic{100e3, 0.4995};
  const double softer = (1.0 - 0.4995 * 0.4995) / 100e3;
  const double tissue = (1.0 - 0.44 * 0.44) / 16.3e3;
  order.share = tissue / (tissue + softer);
  FingerPress elastic(order);
  const auto found = elastic.at_travel(0.83e-3);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->touching, 4);
  EXPECT_EQ(elastic.press().body().copies, 4);
  const double together = 1.0 / (tissue + softer);
  const double depth = contact::hertz::depth(0.25 * found->force, order.radius, together);
  const double ball = (1.0 - order.share) * depth * (1.0 - 0.25 * std::sqrt(depth / order.radius));
  order.ball.reset();
  order.radius /= order.share;
  order.share = 1.0;
  touch(order, Vec3(0.024, 0.022, 0.024));
  FingerPress rigid(order);
  EXPECT_NEAR(rigid.at_travel(0.83e-3 - ball)->force, found->force, 0.02 * found->force);
}

// A shaft that hardly yields, and small contacts: Hertz's ellipse, and what a ball that is held at
// its equator yields less than a half-space: docs/theory.md [ball].
TEST(FingerPress, AnElasticFingerOnAStiffShaftHasHertzsForce) {
  FingerOrder order = plain();
  const double shaft = 14e-3;
  order.body.shape = geometry::Cylinder{shaft, 0.1};
  order.body.tissues = {{17e9, 0.3}};
  order.body.base_level = 0.1 * shaft;
  order.ball = tissue::Isotropic{2050e3, 0.4995};
  const double softer = (1.0 - 0.4995 * 0.4995) / 2050e3;
  const double stiffer = (1.0 - 0.3 * 0.3) / 17e9;
  order.share = stiffer / (softer + stiffer);
  order.radius = 11e-3;
  order.curvatures = {1.0 / shaft, 0.0};
  order.deepest = 0.05e-3;
  touch(order, Vec3(shaft, 0.05, 2.0 * shaft));
  FingerPress press(order);
  const auto found = press.at_travel(order.deepest);
  ASSERT_TRUE(found);
  const auto law = contact::elliptic_law(1.0 / (softer + stiffer), order.radius, 1.0 / shaft, 0.0);
  ASSERT_TRUE(law);
  const double hertz = law->force(order.deepest);
  const double more = 0.375 * std::sqrt(order.deepest / order.radius);
  EXPECT_NEAR(found->force, hertz * (1.0 + more), 0.03 * hertz);  // what one mesh states
}

// Beside the middle of a wide block the force of a slide hardly changes, and begins as pressed.
TEST(FingerPress, SlidesAtADepth) {
  FingerOrder order = plain();
  order.beside = [&](const Vec3& place) {
    return Touch{order.touch.finger + place, order.touch.touched + place};
  };
  FingerPress press(order);
  const double pressed = press.at_travel(0.83e-3)->force;
  const Vec3 end(0.006, 0.0, 0.0);
  for (const double slid : {0.0, 0.001, 0.003, 0.006}) {
    const auto found = press.at_slide(0.83e-3, Vec3::Zero(), end, slid);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->force, pressed, 0.015 * pressed) << slid;  // of other elements
  }
  EXPECT_NEAR(press.at_slide(0.83e-3, Vec3::Zero(), end, 0.0)->force, pressed, 1e-12 * pressed);
  EXPECT_NEAR(press.at_travel(0.83e-3, end)->force,
              press.at_slide(0.83e-3, Vec3::Zero(), end, 0.006)->force, 1e-3 * pressed);
}

TEST(FingerPress, ExtrapolatesWithTheSquareOfTheSize) {
  const std::vector<double> sizes{2.0, 4.0, 8.0};
  std::vector<double> forces;
  for (const double n : sizes) forces.push_back(1.0 + 0.4 / (n * n));
  const Extrapolated one = extrapolated({sizes.data(), 1}, {forces.data(), 1});
  EXPECT_EQ(one.force, forces[0]);
  EXPECT_EQ(one.error, error_of_one_mesh * forces[0]);
  const Extrapolated two = extrapolated({sizes.data(), 2}, {forces.data(), 2});
  EXPECT_NEAR(two.force, 1.0, 1e-12);
  EXPECT_NEAR(two.error, 0.5 * 0.4 / 16.0, 1e-12);  // more than its least, 1 %
  EXPECT_NEAR(extrapolated(sizes, forces).force, 1.0, 1e-12);
  EXPECT_NEAR(extrapolated(sizes, forces).error, error_of_three_meshes, 1e-12);
  forces[1] += 0.1;  // the last two alone say another thing
  EXPECT_GT(extrapolated(sizes, forces).error, 0.02);
}

}  // namespace
}  // namespace palpate::solid
