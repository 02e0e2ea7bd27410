// Laws of tips against closed numbers, their limits and their own slopes.
#include "fit/contact_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::fit {
namespace {

constexpr double tip_radius = 0.01;  // m

TEST(Tip, ClosedNumbers) {
  const double h = 1e-3;
  const double angle = std::numbers::pi / 6.0;  // tan = 1/sqrt(3)
  const auto force = [&](Tip::Kind kind) { return tip_force({kind, tip_radius, angle}, h).force; };
  const double tangent = 1.0 / std::sqrt(3.0);
  EXPECT_NEAR(force(Tip::Kind::paraboloid), 4.0 / 3.0 * 0.1 * std::pow(h, 1.5), 1e-20);  // rounding
  EXPECT_NEAR(force(Tip::Kind::cone), 2.0 / std::numbers::pi * tangent * 1e-6, 1e-20);   // rounding
  EXPECT_NEAR(force(Tip::Kind::pyramid_3), 0.8887 * tangent * 1e-6, 1e-20);              // rounding
  EXPECT_NEAR(force(Tip::Kind::pyramid_4), 0.7453 * tangent * 1e-6, 1e-20);              // rounding
  EXPECT_NEAR(force(Tip::Kind::flat_punch), 2.0 * tip_radius * h, 1e-18);                // rounding
  EXPECT_EQ(tip_force({Tip::Kind::sphere, tip_radius, 0.0}, -h).force, 0.0);
}

// a/R = 1/2: h/R = 1/4 ln 3 and F/R^2 = 5/8 ln 3 - 1/2, from Sneddon's formulas with logarithms.
TEST(Tip, SphereByHand) {
  const double third = std::log(3.0);
  const TipForce at = tip_force({Tip::Kind::sphere, tip_radius, 0.0}, tip_radius * 0.25 * third);
  EXPECT_NEAR(at.force, tip_radius * tip_radius * (0.625 * third - 0.5), 1e-18);  // rounding
  EXPECT_NEAR(at.stiffness, 2.0 * tip_radius * 0.5, 1e-16);                       // 2 a, rounding
}

// For small depths the sphere is the paraboloid: F / F_Hertz = 1 - h / (10 R) + ...
TEST(Tip, SphereNearContactIsHertz) {
  for (const double share : {1e-6, 1e-4, 1e-3}) {
    const double h = share * tip_radius;
    const double ratio = tip_force({Tip::Kind::sphere, tip_radius, 0.0}, h).force /
                         tip_force({Tip::Kind::paraboloid, tip_radius, 0.0}, h).force;
    EXPECT_NEAR(ratio, 1.0 - 0.1 * share, share * share);  // the next term of the series
  }
}

TEST(Tip, StiffnessIsTheSlope) {
  for (const Tip::Kind kind : {Tip::Kind::paraboloid, Tip::Kind::sphere, Tip::Kind::cone,
                               Tip::Kind::pyramid_3, Tip::Kind::pyramid_4, Tip::Kind::flat_punch})
    for (const double h : {1e-5, 1e-3, 8e-3, 3e-2}) {
      const Tip tip{kind, tip_radius, 0.4};
      const double step = 1e-5 * h;
      const double slope =
          (tip_force(tip, h + step).force - tip_force(tip, h - step).force) / (2.0 * step);
      EXPECT_NEAR(tip_force(tip, h).stiffness / slope, 1.0, 1e-8) << word(kind);  // differences
      EXPECT_EQ(find_tip(word(kind)), kind);
    }
}

}  // namespace
}  // namespace palpate::fit
