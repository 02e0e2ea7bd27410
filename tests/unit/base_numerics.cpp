// Roots, minima and Gauss points of functions that are known; Student's t against its closed forms
// and the printed tables.
#include "base/numerics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::numerics {
namespace {

TEST(Student, OneDegreeIsCauchy) {
  for (const double p : {0.6, 0.9, 0.975, 0.999})
    EXPECT_NEAR(student_t_quantile(p, 1), std::tan(std::numbers::pi * (p - 0.5)),
                1e-12 * std::tan(std::numbers::pi * (p - 0.5)));  // rounding of 1 - p, times 40
}

TEST(Student, TwoDegreesHaveAClosedForm) {
  for (const double p : {0.6, 0.9, 0.975, 0.999}) {
    const double exact = (2 * p - 1) * std::sqrt(2 / (1 - (2 * p - 1) * (2 * p - 1)));
    EXPECT_NEAR(student_t_quantile(p, 2), exact, 1e-12 * exact);  // rounding
  }
}

// NIST/SEMATECH e-Handbook 1.3.6.7.2, upper 0.025 and 0.005.
TEST(Student, PrintedTable) {
  const double rounding = 0.0005;  // the table has three decimals
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.706, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 3), 3.182, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 5), 2.571, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.228, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 28), 2.048, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 30), 2.042, rounding);
  EXPECT_NEAR(student_t_quantile(0.975, 100), 1.984, rounding);
  EXPECT_NEAR(student_t_quantile(0.995, 10), 3.169, rounding);
  EXPECT_NEAR(student_t_quantile(0.995, 60), 2.660, rounding);
}

TEST(Student, ManyDegreesAreNormal) {
  // t = z + (z^3 + z) / (4 v) + ...: at v = 1e6 the first term is 2.4e-6.
  EXPECT_NEAR(student_t_quantile(0.975, 1e6), 1.959963984540054, 3e-6);
}

// With t = sqrt(v) tan(theta) the density is Gamma((v+1)/2) / (sqrt(pi) Gamma(v/2)) cos^(v-1).
TEST(Student, IntegralOfTheDensityIsTheProbability) {
  const GaussRule& rule = gauss_rule(60);
  for (const double degrees : {1.0, 2.0, 4.0, 7.0, 29.0, 400.0, 1e5})
    for (const double p : {0.001, 0.025, 0.3, 0.5, 0.8, 0.995}) {
      const double end = std::atan(student_t_quantile(p, degrees) / std::sqrt(degrees));
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += 0.5 * end * rule.weights[i] *
               std::pow(std::cos(0.5 * end * (1.0 + rule.nodes[i])), degrees - 1.0);
      const double scale = std::lgamma(0.5 * degrees + 0.5) - std::lgamma(0.5 * degrees);
      EXPECT_NEAR(0.5 + sum * std::exp(scale) / std::sqrt(std::numbers::pi), p,
                  1e-10);  // lgamma's rounding grows with the degrees
    }
}

TEST(Student, IsSymmetric) {
  EXPECT_EQ(student_t_quantile(0.5, 6), 0.0);
  EXPECT_EQ(student_t_quantile(0.25, 6), -student_t_quantile(0.75, 6));
}

TEST(Root, HasTheSignsAtItsEnds) {
  const auto cubic = [](double x) { return x * x * x - 2.0; };
  const Interval found = root({0.0, 1e6}, cubic);
  EXPECT_LE(cubic(found.low), 0.0);
  EXPECT_GE(cubic(found.high), 0.0);
  EXPECT_NEAR(found.middle(), std::cbrt(2.0),
              4e-16 * std::cbrt(2.0));  // two units in the last place
  const auto falling = [](double x) { return std::exp(-x) - 1e-3; };
  EXPECT_NEAR(root({-700.0, 700.0}, falling).middle(), std::log(1e3), 4e-16 * std::log(1e3));
}

TEST(Root, IsTheNearerEndWithoutAChangeOfSign) {
  const auto line = [](double x) { return x; };
  EXPECT_EQ(root({1.0, 2.0}, line).low, 1.0);
  EXPECT_EQ(root({-2.0, -1.0}, line).high, -1.0);
  EXPECT_EQ(root({0.0, 1.0}, line).middle(), 0.0);
}

TEST(Root, ByNewtonsMethodStaysWithinAndIsExact) {
  const auto atan = [](double x) {
    return Tangent{std::atan(x - 3.0), 1.0 / (1.0 + (x - 3.0) * (x - 3.0))};
  };
  for (const double start : {-50.0, 0.0, 2.9, 3.0, 70.0})  // plain Newton steps diverge from afar
    EXPECT_NEAR(root(start, {-100.0, 100.0}, atan), 3.0, 2e-15) << start;  // rounding of x - 3
  const auto hertz = [](double h) {
    return Tangent{h + std::sqrt(h) * h - 1e-9, 1.0 + 1.5 * std::sqrt(h)};
  };
  const double h = root(1e-9, {0.0, 1e-9}, hertz);
  EXPECT_NEAR(hertz(h).value, 0.0, 4e-25);  // two units in the last place of 1e-9
}

TEST(Change, EndsAtNeighbouringNumbers) {
  int asked = 0;
  const Interval found = change({0.0, 10.0}, 0.0, [&](double x) {
    ++asked;
    return x * x <= 2.0;
  });
  EXPECT_EQ(std::nextafter(found.low, 10.0), found.high);
  EXPECT_LE(found.low * found.low, 2.0);
  EXPECT_GT(found.high * found.high, 2.0);
  EXPECT_LT(asked, 64);
  const Interval coarse = change({1.0, 2.0}, 1e-3, [](double x) { return x < 1.7; });
  EXPECT_LE(coarse.high - coarse.low, 1e-3 * coarse.high);
  EXPECT_TRUE(coarse.low < 1.7 && coarse.high >= 1.7);
}

TEST(Minimum, OfAParabolaAndBesideAWall) {
  const Interval range{2e-3, 9e-3};
  const auto parabola = [](double x) { return (x - 4e-3) * (x - 4e-3); };
  EXPECT_NEAR(minimum(range, parabola), 4e-3, 1e-8 * 7e-3);
  const auto wall = [](double x) { return x < 4e-3 ? std::numeric_limits<double>::infinity() : x; };
  EXPECT_NEAR(minimum(range, wall), 4e-3, 2e-8 * 7e-3);
}

// A rule of n points integrates polynomials up to degree 2 n - 1 exactly; its nodes ascend.
TEST(GaussRule, IntegratesPolynomials) {
  for (const int points : {1, 2, 3, 6, 21, 60, 300}) {
    const GaussRule& rule = gauss_rule(points);
    ASSERT_EQ(rule.nodes.size(), static_cast<std::size_t>(points));
    ASSERT_EQ(rule.weights.size(), rule.nodes.size());
    EXPECT_TRUE(std::is_sorted(rule.nodes.begin(), rule.nodes.end()));
    for (const int degree : {0, 1, points - 1, 2 * points - 2, 2 * points - 1}) {
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
      EXPECT_NEAR(sum, degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0, 1e-13)  // rounding
          << points << " points, degree " << degree;
    }
  }
}

}  // namespace
}  // namespace palpate::numerics
