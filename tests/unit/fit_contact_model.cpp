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

TEST(ContactModel, Refusals) {
  Curve curve = hertz_curve();
  EXPECT_EQ(refusal({{0, 1e-3, 2e-3}, {0, 1, 2}}, {radius, poisson}),
            "the model `hertz` needs at least 4 points, and 3 are usable; record more points");
  EXPECT_EQ(refusal({{1, 1, 1, 1}, {0, 1, 2, 3}}, {radius, poisson}),
            "all points have the same depth; give a curve over depth");
  EXPECT_EQ(refusal(curve, {radius, poisson, 1e-4}),
            "the curve is deeper than 0.008182 mm, up to which the law of so thin a layer is "
            "valid; give the part of the curve up to that depth");
  for (double& force : curve.force) force = -force;
  EXPECT_EQ(refusal(curve, {radius, poisson}),
            "the load falls with depth; give `--compression negative` if the load cell reports "
            "compression as negative, or another `--x`");
}

}  // namespace
}  // namespace palpate::fit
