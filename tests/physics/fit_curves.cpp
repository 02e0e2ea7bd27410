// The three regressions of a Hertz curve, against numbers computed independently of this project.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/regression.h"
#include "fitted_value.h"

namespace palpate::fit {
namespace {

// Skin at h = 0.1, 0.2 ... 3.0 mm: F = 4/3 E* sqrt(R) h^(3/2), E* of case hertz-01, R = 11 mm.
struct Curve {
  std::vector<double> x;  // mm
  std::vector<double> y;  // N
};
Curve skin() {
  Curve curve;
  for (int i = 1; i <= 30; ++i) {
    const double depth = i * 1e-4;
    curve.x.push_back(i / 10.0);
    curve.y.push_back(4.0 / 3.0 * 78902.531 * std::sqrt(0.011) * depth * std::sqrt(depth));
  }
  return curve;
}

TEST(HertzCurve, LogarithmicRegressionOfSkin) {
  const Curve curve = skin();
  const Fit fit = regress(curve.x, curve.y, Model::logarithmic, {.x_unit = "mm", .y_unit = "N"});
  EXPECT_NEAR(fit.parameters[0].estimate, 0.64930904, 1e-6 * 0.64930904);  // log-01, its rel_tol
  EXPECT_EQ(fit.parameters[0].unit, "N");
  double lowest = std::numeric_limits<double>::infinity();
  for (const double x : curve.x) lowest = std::min(lowest, test::value(fit, x));
  EXPECT_NEAR(lowest, -0.66730649, 1e-6 * 0.66730649);  // log-04, its rel_tol
  // The curve is concave, Hertz convex: the published figures 0.5718 N and 0.746 in their digits.
  EXPECT_NEAR(fit.parameters[1].estimate, 0.5718, 5e-5);
  EXPECT_NEAR(fit.r2, 0.746, 5e-4);
}

TEST(HertzCurve, PowerIsThreeHalves) {
  const Curve curve = skin();
  const Fit fit = regress(curve.x, curve.y, Model::power, {.x_unit = "mm", .y_unit = "N"});
  EXPECT_NEAR(fit.parameters[1].estimate, 1.5, 1e-9 * 1.5);  // log-05, its rel_tol
  EXPECT_EQ(fit.parameters[0].unit, "N/mm^n");
  std::vector<double> log_y;
  for (const double y : curve.y) log_y.push_back(std::log(y));
  const Fit in_logs = regress(curve.x, log_y, Model::logarithmic);
  EXPECT_NEAR(in_logs.parameters[1].estimate, 1.5, 1e-9 * 1.5);  // log-05 as it is written
}

TEST(HertzCurve, ConvexModelsFitBetter) {
  const Curve curve = skin();
  const double logarithmic = regress(curve.x, curve.y, Model::logarithmic).r2;
  const double exponential = regress(curve.x, curve.y, Model::exponential).r2;
  const double power = regress(curve.x, curve.y, Model::power).r2;
  EXPECT_LT(logarithmic, exponential);
  EXPECT_LT(exponential, power);
}

// A Voigt solid: eps = (s/E)(1 - e^(-t/tau)), tau = eta/E; at t = tau it has reached 63.2 %.
TEST(VoigtCurve, CreepAndRecoveryShareTheirTime) {
  const double tau = 0.62, strain = 0.138;
  std::vector<double> time, creep, recovery;
  for (int i = 0; i <= 200; ++i) {
    time.push_back(0.01 * i);
    creep.push_back(strain * (1 - std::exp(-time.back() / tau)));
    recovery.push_back(strain * std::exp(-time.back() / tau));
  }
  const Fit up = regress(time, creep, Model::kelvin_voigt, {.x_unit = "s"});
  const Fit down = regress(time, recovery, Model::kelvin_voigt_recovery, {.x_unit = "s"});
  EXPECT_NEAR(up.parameters[1].estimate, tau, 1e-9);    // exact data, condition below 1e3
  EXPECT_NEAR(down.parameters[1].estimate, tau, 1e-9);  // likewise
  EXPECT_EQ(up.parameters[1].unit, "s");
  EXPECT_NEAR(test::value(up, tau), strain * 0.6321205588285577, 1e-10);  // 1 - 1/e
}

}  // namespace
}  // namespace palpate::fit
