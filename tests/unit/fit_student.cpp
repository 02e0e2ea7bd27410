// Student's t against its closed forms and the printed tables.
#include "fit/student.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::fit {
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

TEST(Student, QuantileUndoesTheDistribution) {
  for (const double degrees : {1.0, 2.0, 4.0, 7.0, 29.0, 400.0, 1e5})
    for (const double p : {0.001, 0.025, 0.3, 0.5, 0.8, 0.995})
      EXPECT_NEAR(student_t_cdf(student_t_quantile(p, degrees), degrees), p,
                  1e-11);  // lgamma's rounding grows with the degrees
}

TEST(Student, QuantileDoesNotDependOnEarlierOnes) {
  const double first = student_t_quantile(0.975, 7.0);
  for (int degrees = 1; degrees < 50; ++degrees) {
    EXPECT_LT(student_t_quantile(0.9, degrees), student_t_quantile(0.975, degrees));
    EXPECT_EQ(student_t_quantile(0.975, 7.0), first);
  }
}

TEST(Student, IsSymmetric) {
  EXPECT_EQ(student_t_quantile(0.5, 6), 0.0);
  EXPECT_EQ(student_t_quantile(0.025, 6), -student_t_quantile(0.975, 6));
}

}  // namespace
}  // namespace palpate::fit
