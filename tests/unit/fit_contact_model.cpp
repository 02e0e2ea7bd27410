// Young's modulus and the contact point out of curves whose truth is known.
#include "fit/contact_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "contact/layer.h"
#include "refusal.h"

namespace palpate::fit {
namespace {

constexpr double radius = 11e-3;  // m
constexpr double poisson = 0.45;
constexpr double young = 72.4e3;     // Pa
constexpr double contact_at = 4e-4;  // m

struct Curve {
  std::vector<double> depth;
  std::vector<double> force;
};

// Depths from 0 to 3 mm; without contact before 0.4 mm.
Curve hertz_curve() {
  Curve curve;
  for (int i = 0; i <= 60; ++i) {
    const double h = std::max(0.0, i * 5e-5 - contact_at);
    curve.depth.push_back(i * 5e-5);
    curve.force.push_back(4.0 / 3.0 * young / (1 - poisson * poisson) * std::sqrt(radius) * h *
                          std::sqrt(h));
  }
  return curve;
}

Curve layer_curve(double thickness, contact::LayerBase base) {
  const contact::LayerContact contact{radius, young / (1 - poisson * poisson), thickness,
                                      contact::LayerLaw({.poisson_ratio = poisson, .base = base})};
  Curve curve;
  for (int i = 0; i <= 60; ++i) {
    curve.depth.push_back(i * 5e-5);
    curve.force.push_back(contact.force(i * 5e-5 - contact_at));
  }
  return curve;
}

std::string refusal(const Curve& curve, const ContactTest& test) {
  return test::refusal([&] { return fit_contact(curve.depth, curve.force, test); });
}

TEST(ContactModel, HertzExactly) {
  const Curve curve = hertz_curve();
  const Fit fit = fit_contact(curve.depth, curve.force, {radius, poisson});
  EXPECT_EQ(fit.name, "hertz");
  EXPECT_EQ(word(fit.termination), "converged");
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data: the solver's own end
  EXPECT_NEAR(fit.parameters[1].estimate, 0.4, 1e-8);          // likewise
  EXPECT_EQ(fit.parameters[0].unit + fit.parameters[1].unit, "kPamm");
  EXPECT_EQ(fit.n, 61);
  EXPECT_DOUBLE_EQ(fit.range_high, 3.0);
  EXPECT_NEAR(fit.r2, 1.0, 1e-12);  // rounding
}

// A contact point and an offset that are 0 but for rounding are determined all the same.
TEST(ContactModel, ExactlyFromZero) {
  Curve curve = hertz_curve();
  for (double& each : curve.depth) each -= contact_at;
  const Fit fit = fit_contact(curve.depth, curve.force, {radius, poisson});
  ASSERT_EQ(word(fit.termination), "converged");
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data
  for (std::size_t i = 1; i < fit.parameters.size(); ++i)
    EXPECT_NEAR(fit.parameters[i].estimate, 0.0, 1e-8) << fit.parameters[i].name;
}

TEST(ContactModel, LayerExactlyAndHertzTooStiffOnIt) {
  for (const contact::LayerBase base :
       {contact::LayerBase::bonded, contact::LayerBase::frictionless}) {
    const Curve curve = layer_curve(6e-3, base);
    const Fit layer = fit_contact(curve.depth, curve.force, {radius, poisson, 6e-3, base});
    EXPECT_EQ(layer.name, "layer");
    EXPECT_NEAR(layer.parameters[0].estimate, 72.4, 1e-7 * 72.4);  // slopes of the table: 1e-6
    EXPECT_NEAR(layer.parameters[1].estimate, 0.4, 1e-7);
    // sqrt(R h) is 0.9 of the thickness at the deepest: a half-space would have to be stiffer.
    const Fit hertz = fit_contact(curve.depth, curve.force, {radius, poisson});
    EXPECT_GT(hertz.parameters[0].estimate, 1.3 * 72.4);
  }
}

// Of 200 noisy curves about 190 hold the truth in their 95 % interval: 200 draws of 0.95 stray by
// 3.1, so that 180 to 199 is more than three of them to either side.
TEST(ContactModel, IntervalsHoldTheTruth) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  int young_held = 0;
  int contact_held = 0;
  for (int i = 0; i < 200; ++i) {
    Curve curve = hertz_curve();
    for (double& force : curve.force) force += 0.01 * curve.force.back() * noise(random);
    const Fit fit = fit_contact(curve.depth, curve.force, {radius, poisson});
    const auto holds = [&](std::size_t k, double truth) {
      return fit.parameters[k].ci95_low < truth && truth < fit.parameters[k].ci95_high;
    };
    young_held += holds(0, 72.4) ? 1 : 0;
    contact_held += holds(1, 0.4) ? 1 : 0;
  }
  EXPECT_GE(young_held, 180);
  EXPECT_LE(young_held, 199);
  EXPECT_GE(contact_held, 180);
  EXPECT_LE(contact_held, 199);
}

// A file that begins at the contact, as texture analysers write: noise makes a straight line of the
// first rows, which is no baseline. 100 draws of 0.95 stray by 2.2.
TEST(ContactModel, IntervalsHoldTheTruthFromTheFirstRowOn) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> noise(0.0, 1.0);
  int held = 0;
  for (int i = 0; i < 100; ++i) {
    Curve curve;
    for (int k = 0; k <= 150; ++k) {
      const double h = k / 150.0 * 1e-3;
      const double law =
          4.0 / 3.0 * young / (1 - poisson * poisson) * std::sqrt(radius) * h * std::sqrt(h);
      curve.depth.push_back(h);
      curve.force.push_back(law + 0.015 * noise(random));  // N, of 0.42 at the end
    }
    const Fit fit = fit_contact(curve.depth, curve.force, {radius, poisson});
    held += fit.parameters[0].ci95_low < 72.4 && 72.4 < fit.parameters[0].ci95_high ? 1 : 0;
  }
  EXPECT_GE(held, 88);
}

TEST(ContactModel, Refusals) {
  Curve curve = hertz_curve();
  EXPECT_EQ(refusal({{0, 1e-3, 2e-3}, {0, 1, 2}}, {radius, poisson}),
            "the model `hertz` needs at least 4 points, and 3 are usable; record more points");
  EXPECT_EQ(refusal({{1, 1, 1, 1}, {0, 1, 2, 3}}, {radius, poisson}),
            "all points have the same depth; give a curve over depth");
  EXPECT_EQ(refusal(curve, {radius, poisson, 1e-4}),
            "the curve is deeper than 0.008182 mm, up to which the law of so thin a layer is "
            "valid; give the part of the curve up to that depth, by `--to`");
  for (double& force : curve.force) force = -force;
  EXPECT_EQ(refusal(curve, {radius, poisson}),
            "the load falls with depth; give `--compression negative` if the load cell reports "
            "compression as negative, or another `--x`");
}

// A press with a force offset and a tilted baseline, as cantilevers have them.
struct Tilted {
  double offset = -2.0;  // N
  double tilt = 0.0;     // N/m
  double from = -3e-3;   // m, first depth
  int rows = 300;
};
Curve tilted_curve(const Tip& tip, const Tilted& tilted) {
  Curve curve;
  for (int i = 0; i < tilted.rows; ++i) {
    const double h = tilted.from + (3e-3 - tilted.from) * i / (tilted.rows - 1);
    curve.depth.push_back(h);
    curve.force.push_back(young / (1 - poisson * poisson) * tip_force(tip, h - contact_at).force +
                          tilted.offset + tilted.tilt * (h - tilted.from));
  }
  return curve;
}

ContactTest test_of(const Tip& tip) {
  ContactTest test{radius, poisson};
  test.tip = tip.kind;
  test.half_angle = tip.half_angle;
  return test;
}

TEST(ContactModel, EveryTipExactlyWithOffsetAndTilt) {
  for (const Tip::Kind kind : {Tip::Kind::paraboloid, Tip::Kind::sphere, Tip::Kind::cone,
                               Tip::Kind::pyramid_3, Tip::Kind::pyramid_4, Tip::Kind::flat_punch}) {
    const Tip tip{kind, radius, 0.6};
    const Curve curve = tilted_curve(tip, {.offset = -2.0, .tilt = 100.0});
    const Fit fit = fit_contact(curve.depth, curve.force, test_of(tip));
    ASSERT_EQ(fit.parameters.size(), 4U) << word(kind);
    EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-9 * 72.4) << word(kind);  // exact data
    EXPECT_NEAR(fit.parameters[1].estimate, 0.4, 1e-9) << word(kind);          // likewise
    EXPECT_NEAR(fit.parameters[2].estimate, -2.0, 1e-9) << word(kind);         // likewise
    EXPECT_NEAR(fit.parameters[3].estimate, 0.1, 1e-9) << word(kind);          // likewise, N/mm
  }
}

TEST(ContactModel, ABaselineIsFittedWhereRowsLieBeforeContact) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  const auto parameters = [&](double from, int rows) {
    const Curve curve = tilted_curve(tip, {.offset = 0.5, .from = from, .rows = rows});
    return fit_contact(curve.depth, curve.force, test_of(tip)).parameters.size();
  };
  EXPECT_EQ(parameters(-3e-3, 300), 4U);   // 170 rows before contact: offset and tilt
  EXPECT_EQ(parameters(2.5e-4, 100), 3U);  // 6 rows before contact: an offset
  // No row before contact and no offset: modulus and contact point.
  const Curve curve = tilted_curve(tip, {.offset = 0.0, .from = 5e-4});
  const Fit fit = fit_contact(curve.depth, curve.force, test_of(tip));
  EXPECT_EQ(fit.parameters.size(), 2U);
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_TRUE(fit.warnings[0].starts_with("no row lies before contact")) << fit.warnings[0];
}

TEST(ContactModel, TheWayBackIsLeftOutAndCounted) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  Curve curve = tilted_curve(tip, {});
  for (std::size_t i = 300; i-- > 0;) {
    curve.depth.push_back(curve.depth[i]);
    curve.force.push_back(0.5 * curve.force[i]);
  }
  ContactTest test = test_of(tip);
  const Fit approach = fit_contact(curve.depth, curve.force, test);
  EXPECT_NEAR(approach.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data
  EXPECT_EQ(approach.n, 300);
  EXPECT_EQ(approach.excluded, 300);
  test.way = ContactTest::Way::retract;
  const Fit retract = fit_contact(curve.depth, curve.force, test);
  // The deepest row belongs to both ways and has the force of the approach: 1 of 301 rows.
  EXPECT_NEAR(retract.parameters[0].estimate, 36.2, 0.02 * 36.2);
  EXPECT_EQ(retract.excluded, 299);
}

// Beyond 1 mm the tissue stiffens up to 80 times; the part up to there gives the modulus.
TEST(ContactModel, APartOfTheDepths) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  Curve curve = tilted_curve(tip, {});
  for (std::size_t i = 0; i < curve.depth.size(); ++i) {
    const double beyond = std::max(0.0, curve.depth[i] - contact_at - 1e-3);
    curve.force[i] += beyond * 5e4 * (curve.force[i] + 2.0);
  }
  ContactTest test = test_of(tip);
  test.to = DepthLimit{0.9e-3, false};
  const Fit fit = fit_contact(curve.depth, curve.force, test);
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data
  EXPECT_NEAR(fit.range_high, 1.3, 0.03);                      // the spacing of the rows
  EXPECT_EQ(fit.n + fit.excluded, 300);
}

TEST(ContactModel, ASignIsAdvisedOnlyWhereItIsWrong) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  const ContactTest test = test_of(tip);
  const Curve good = tilted_curve(tip, {.offset = -40.0, .tilt = 100.0});
  EXPECT_NEAR(fit_contact(good.depth, good.force, test).parameters[0].estimate, 72.4,
              1e-7);  // exact data, all forces negative
  Curve curve = good;
  for (double& force : curve.force) force = -force;
  EXPECT_TRUE(refusal(curve, test)
                  .starts_with("the load falls with depth; give "
                               "`--compression negative`"))
      << refusal(curve, test);
  curve = good;
  for (double& depth : curve.depth) depth = -depth;
  EXPECT_TRUE(refusal(curve, test).starts_with("the load grows as the depth falls"))
      << refusal(curve, test);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (double& force : curve.force) force = noise(random);
  EXPECT_NE(refusal(curve, test).find("shows no contact"), std::string::npos)
      << refusal(curve, test);
}

TEST(ContactModel, AKnownContactPointIsNoParameter) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  const Curve curve = tilted_curve(tip, {.offset = 0.2, .tilt = 10.0});
  ContactTest test = test_of(tip);
  test.contact_point = contact_at;
  const Fit fit = fit_contact(curve.depth, curve.force, test);
  ASSERT_EQ(fit.parameters.size(), 3U);
  EXPECT_EQ(fit.parameters[1].name, "F_0");
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-8 * 72.4);  // exact data
  EXPECT_NEAR(fit.parameters[2].estimate, 0.01, 1e-9);         // N/mm
}

// A bump between 0.1 and 0.35 mm, as of a surface that attracts the tip, is no baseline.
TEST(ContactModel, ABaselineOfChosenRows) {
  const Tip tip{Tip::Kind::paraboloid, radius, 0.0};
  Curve curve = tilted_curve(tip, {.offset = 0.2, .tilt = 10.0});
  for (std::size_t i = 0; i < curve.depth.size(); ++i)
    if (curve.depth[i] > 1e-4 && curve.depth[i] < 3.5e-4) curve.force[i] -= 0.05;
  ContactTest test = test_of(tip);
  test.baseline = ContactTest::BaselineChoice::tilt;
  const Fit all = fit_contact(curve.depth, curve.force, test);
  EXPECT_GT(std::abs(all.parameters[0].estimate - 72.4), 0.1);
  test.baseline_to = 0.95e-4;
  const Fit fit = fit_contact(curve.depth, curve.force, test);
  EXPECT_NEAR(fit.parameters[0].estimate, 72.4, 1e-6 * 72.4);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 0.4, 1e-6);
}

}  // namespace
}  // namespace palpate::fit
