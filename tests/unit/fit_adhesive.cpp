// JKR and DMT against their parametric forms and published pull-off forces.
#include "fit/contact_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "refusal.h"

namespace palpate::fit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double bead = 2.5e-6;  // m
constexpr double reduced = 1e4;  // Pa, E*
constexpr double sticky = 2e-5;  // J/m^2

struct Pulled {
  std::vector<double> depth, force;
};

// JKR by its contact radius, from the deepest to the opening, then free rows; h_0 = 1 um.
Pulled jkr_rows() {
  Pulled rows;
  const double opening = std::cbrt(pi * sticky * bead * bead / (8.0 * reduced));
  const double pull = 1.5 * pi * sticky * bead;
  for (int i = 0; i <= 300; ++i) {
    const double a = opening * (3.5 - 2.4 * i / 300.0);
    rows.depth.push_back(1e-6 + a * a / bead - std::sqrt(2.0 * pi * a * sticky / reduced));
    rows.force.push_back(4.0 * reduced * a * a * a / (3.0 * bead) -
                         std::sqrt(8.0 * pi * sticky * reduced * a * a * a));
  }
  const double last = rows.depth.back();
  for (int i = 1; i <= 150; ++i) {
    rows.depth.push_back(last - 4e-9 * i);
    rows.force.push_back(0.0);
  }
  for (double& each : rows.force) each += 0.1 * pull;
  return rows;
}

double of(const Fit& fit, const std::string& name) {
  for (const Estimate& one : fit.parameters)
    if (one.name == name) return one.estimate;
  return std::nan("");
}

TEST(Adhesive, PullOffForces) {
  double least = 0.0;
  for (double depth = -3e-7; depth < 3e-7; depth += 1e-11)
    least = std::min(least, adhesive_force(Adhesion::jkr, bead, reduced, sticky, depth).force);
  EXPECT_NEAR(least, -1.5 * pi * sticky * bead, 1e-6 * pi * sticky * bead);  // the grid of depths
  EXPECT_DOUBLE_EQ(adhesive_force(Adhesion::dmt, bead, reduced, sticky, 0.0).force,
                   -2.0 * pi * sticky * bead);
  // Contact opens at 5/9 of the pull-off force: Johnson, Kendall and Roberts 1971.
  EXPECT_NEAR(adhesive_force(Adhesion::jkr, bead, reduced, sticky, -1.0).force,
              -5.0 / 6.0 * pi * sticky * bead, 1e-12 * sticky * bead);
  // Without adhesion both are Hertz's law.
  const double hertz = 4.0 / 3.0 * reduced * std::sqrt(bead) * std::pow(1e-7, 1.5);
  EXPECT_NEAR(adhesive_force(Adhesion::jkr, bead, reduced, 1e-18, 1e-7).force, hertz, 1e-5 * hertz);
  EXPECT_NEAR(adhesive_force(Adhesion::dmt, bead, reduced, 0.0, 1e-7).force, hertz, 1e-12 * hertz);
}

TEST(Adhesive, DerivativesAreThoseOfTheForce) {
  for (const Adhesion law : {Adhesion::jkr, Adhesion::dmt})
    for (const double depth : {-2e-8, 1e-8, 2e-7}) {
      const auto force = [&](double e, double w, double h) {
        return adhesive_force(law, bead, e, w, h).force;
      };
      const AdhesiveForce at = adhesive_force(law, bead, reduced, sticky, depth);
      const double step = 1e-5;
      const double unit = pi * sticky * bead;
      // Central differences with an error of step^2.
      EXPECT_NEAR(at.by_modulus * reduced,
                  (force(reduced * (1 + step), sticky, depth) -
                   force(reduced * (1 - step), sticky, depth)) /
                      (2 * step),
                  1e-6 * unit);
      EXPECT_NEAR(at.by_work * sticky,
                  (force(reduced, sticky * (1 + step), depth) -
                   force(reduced, sticky * (1 - step), depth)) /
                      (2 * step),
                  1e-6 * unit);
      EXPECT_NEAR(at.by_depth * 1e-8,
                  (force(reduced, sticky, depth + 1e-8 * step) -
                   force(reduced, sticky, depth - 1e-8 * step)) /
                      (2 * step),
                  1e-5 * unit);
    }
}

TEST(Adhesive, JkrExactlyAndChosenByTabor) {
  const Pulled rows = jkr_rows();
  const Fit fit = fit_adhesive(rows.depth, rows.force,
                               {.radius = bead, .poisson_ratio = 0.5, .way = Way::retract}, {});
  EXPECT_EQ(fit.name, "jkr");
  EXPECT_NEAR(of(fit, "E"), 7.5, 1e-6);     // kPa, exact data: E* (1 - nu^2)
  EXPECT_NEAR(of(fit, "w"), 0.02, 1e-8);    // mJ/m^2
  EXPECT_NEAR(of(fit, "h_0"), 1e-3, 1e-9);  // mm
  // mu = (R w^2 / (E*^2 z_0^3))^(1/3)
  const double tabor = std::cbrt(bead * sticky * sticky / (reduced * reduced)) / 0.3e-9;
  EXPECT_NEAR(tabor, 71.8, 0.05);
  EXPECT_NE(fit.notes.back().find("Tabor's number is 71.8 (atoms 0.3 nm apart at rest), which "
                                  "chooses `jkr`"),
            std::string::npos)
      << fit.notes.back();
}

TEST(Adhesive, DmtOfAStiffContact) {
  const double stiff = 1e11;
  Pulled rows;
  for (int i = 0; i <= 200; ++i) {
    const double h = 2e-9 * (1.0 - i / 200.0);
    rows.depth.push_back(h);
    rows.force.push_back(4.0 / 3.0 * stiff * std::sqrt(1e-8) * h * std::sqrt(h) -
                         2.0 * pi * 1e-8 * 0.02);
  }
  for (int i = 1; i <= 100; ++i) {
    rows.depth.push_back(-1e-11 * i);
    rows.force.push_back(0.0);
  }
  const Fit fit = fit_adhesive(rows.depth, rows.force,
                               {.radius = 1e-8, .poisson_ratio = 0.3, .way = Way::retract}, {});
  EXPECT_EQ(fit.name, "dmt");
  EXPECT_NEAR(of(fit, "E"), 9.1e7, 1e-6 * 9.1e7);  // exact data
  EXPECT_NEAR(of(fit, "w"), 20.0, 1e-6 * 20.0);
}

// JKR over even depths, by bisection of the contact radius between the opening at a fixed depth and
// a radius that is too large; beyond the opening the tip is free. The noise is white, or 0.9 of
// that of the row before and some more.
TEST(Adhesive, IntervalsHold) {
  const auto depth_of = [](double a) {
    return a * a / bead - std::sqrt(2.0 * pi * a * sticky / reduced);
  };
  // dh/da = 0: 2 a / R = sqrt(pi w / (2 E* a))
  const double opening = std::cbrt(pi * sticky * bead * bead / (8.0 * reduced));
  std::vector<double> depth, clean;
  for (int i = 0; i < 400; ++i) {
    depth.push_back(5e-7 - 2.5e-9 * i);
    double low = opening;
    double high = bead;
    for (int k = 0; k < 60; ++k)
      (depth_of(0.5 * (low + high)) < depth.back() ? low : high) = 0.5 * (low + high);
    const double force = 4.0 * reduced * low * low * low / (3.0 * bead) -
                         std::sqrt(8.0 * pi * sticky * reduced * low * low * low);
    clean.push_back(depth.back() < depth_of(opening) ? 0.0 : force);
  }
  const double scatter = 0.03 * 1.5 * pi * sticky * bead;
  for (const double kept : {0.0, 0.9}) {
    int young = 0;
    int work = 0;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      std::mt19937 engine(seed);
      std::normal_distribution<double> normal;
      std::vector<double> force = clean;
      double noise = normal(engine);
      for (double& each : force) {
        each += scatter * noise;
        noise = kept * noise + std::sqrt(1.0 - kept * kept) * normal(engine);
      }
      const Fit fit = fit_adhesive(depth, force,
                                   {.radius = bead,
                                    .poisson_ratio = 0.5,
                                    .way = Way::retract,
                                    .residuals = Residuals::correlated},
                                   {.law = Adhesion::jkr});
      young += fit.parameters[0].ci95_low <= 7.5 && 7.5 <= fit.parameters[0].ci95_high ? 1 : 0;
      work += fit.parameters[1].ci95_low <= 0.02 && 0.02 <= fit.parameters[1].ci95_high ? 1 : 0;
    }
    EXPECT_GE(young, 90) << kept;  // 95 expected; 90 is reached in 98 of 100 such counts
    EXPECT_GE(work, 90) << kept;
  }
}

TEST(Adhesive, Refusals) {
  Pulled rows = jkr_rows();
  const ContactTest test{.radius = bead, .way = Way::retract};
  Pulled hertz = rows;
  for (double& each : hertz.force) each = std::max(each, hertz.force.back());
  EXPECT_TRUE(test::refusal([&] {
                return fit_adhesive(hertz.depth, hertz.force, test, {});
              }).starts_with("the force shows no pull-off"));
  std::mt19937 engine(3);  // nor does the least of many rows with noise
  std::normal_distribution<double> normal(0.0, 0.02 * pi * sticky * bead);
  for (double& each : hertz.force) each += normal(engine);
  EXPECT_TRUE(test::refusal([&] {
                return fit_adhesive(hertz.depth, hertz.force, test, {});
              }).starts_with("the force shows no pull-off"));
  rows.depth.resize(295);
  rows.force.resize(295);
  EXPECT_TRUE(test::refusal([&] {
                return fit_adhesive(rows.depth, rows.force, test, {});
              }).starts_with("the curve ends before the contact opens"));
}

}  // namespace
}  // namespace palpate::fit
