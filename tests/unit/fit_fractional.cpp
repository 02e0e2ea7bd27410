// Spring-pots and the fractional Zener model against closed forms.
#include "fit/prony.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "refusal.h"

namespace palpate::fit {
namespace {

TEST(Fractional, MittagLefflerInClosedForm) {
  for (const double z : {0.0, 1e-3, 0.3, 1.0, 5.0, 20.0}) {
    EXPECT_NEAR(mittag_leffler(1.0, z), std::exp(-z), 1e-11);  // the error of the contour
    EXPECT_NEAR(mittag_leffler(0.5, z), std::exp(z * z) * std::erfc(z), z < 10 ? 1e-11 : 1e-3);
  }
  // E_alpha(-z) = sum (-z)^k / Gamma(alpha k + 1), for small z.
  for (const double alpha : {0.1, 0.35, 0.8}) {
    double sum = 0.0;
    double power = 1.0;
    for (int k = 0; k < 60; ++k, power *= -0.5) sum += power / std::tgamma(alpha * k + 1.0);
    EXPECT_NEAR(mittag_leffler(alpha, 0.5), sum, 1e-10) << alpha;
  }
  // Its asymptote is 1 / (z Gamma(1 - alpha)).
  EXPECT_NEAR(mittag_leffler(0.3, 1e6) * 1e6 * std::tgamma(0.7), 1.0, 1e-5);
}

struct TimeRows {
  std::vector<double> x, y;
};
template <class Curve>
TimeRows time_rows(const Curve& curve, double noise = 0.0, std::uint32_t seed = 0) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  TimeRows rows;
  for (int i = 1; i <= 120; ++i) {
    rows.x.push_back(0.05 * i);
    rows.y.push_back(curve(rows.x.back()) + noise * normal(engine));
  }
  return rows;
}

TEST(Fractional, SpringPotsExactly) {
  const TimeRows fall =
      time_rows([](double t) { return 3.0 * std::pow(t, -0.2) / std::tgamma(0.8); });
  Fit fit =
      fit_fractional(fall.x, fall.y, Fractional::spring_pot, {.x_unit = "s", .y_unit = "kPa"});
  EXPECT_NEAR(fit.parameters[0].estimate, 3.0, 1e-8);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 0.2, 1e-8);
  EXPECT_EQ(fit.parameters[0].unit, "kPa s^beta");
  const TimeRows creep =
      time_rows([](double t) { return 0.5 * std::pow(t, 0.7) / std::tgamma(1.7); });
  fit = fit_fractional(creep.x, creep.y, Fractional::spring_pot_creep, {.x_unit = "s"});
  EXPECT_NEAR(fit.parameters[0].estimate, 0.5, 1e-8);
  EXPECT_NEAR(fit.parameters[1].estimate, 0.7, 1e-8);
  EXPECT_EQ(fit.parameters[0].unit, "1/s^beta");
}

// With beta = 1/2 by erfc, and with beta = 1 the standard linear solid.
TEST(Fractional, ZenerExactly) {
  const TimeRows half = time_rows([](double t) {
    const double z = std::sqrt(t / 0.8);
    return 2.0 + 3.0 * std::exp(z * z) * std::erfc(z);
  });
  const Fit fit =
      fit_fractional(half.x, half.y, Fractional::zener, {.x_unit = "s", .y_unit = "kPa"});
  ASSERT_EQ(fit.termination, Termination::converged);
  for (const auto& [i, truth] :
       {std::pair{0U, 2.0}, std::pair{1U, 5.0}, std::pair{2U, 0.8}, std::pair{3U, 0.5}})
    EXPECT_NEAR(fit.parameters[i].estimate, truth, 1e-5 * truth) << i;  // condition about 1e5
}

TEST(Fractional, IntervalsHold) {
  int exponent = 0;
  int height = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const TimeRows rows =
        time_rows([](double t) { return 3.0 * std::pow(t, -0.2) / std::tgamma(0.8); }, 0.05, seed);
    const Fit fit = fit_fractional(rows.x, rows.y, Fractional::spring_pot,
                                   {.residuals = Residuals::correlated});
    height += std::abs(fit.parameters[0].estimate - 3.0) <
                      fit.parameters[0].ci95_high - fit.parameters[0].estimate
                  ? 1
                  : 0;
    exponent += std::abs(fit.parameters[1].estimate - 0.2) <
                        fit.parameters[1].ci95_high - fit.parameters[1].estimate
                    ? 1
                    : 0;
  }
  EXPECT_GE(height, 90);  // 95 expected; 90 is reached in 98 of 100 such counts
  EXPECT_GE(exponent, 90);
}

TEST(Fractional, TooFewPointsAreRefused) {
  const std::vector<double> x{-1.0, 0.0, 1.0, 2.0};
  const std::vector<double> y{4.0, 3.0, 2.0, 1.0};
  EXPECT_EQ(test::refusal([&] { return fit_fractional(x, y, Fractional::spring_pot); }),
            "the model `spring_pot` needs at least 3 points after the step, and 2 are usable; "
            "record more points, or give `--origin`");
}

}  // namespace
}  // namespace palpate::fit
