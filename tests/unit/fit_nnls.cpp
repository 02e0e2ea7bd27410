// Non-negative least squares against its conditions of optimality.
#include "fit/prony.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

namespace palpate::fit {
namespace {

TEST(Nnls, ByHand) {
  // Without the bound x = (2, -1); on the border x_2 = 0 the best x_1 is 3/2.
  Eigen::MatrixXd a(2, 2);
  a << 1.0, 1.0, 1.0, 0.0;
  const Eigen::Vector2d b(1.0, 2.0);
  const auto x = nonnegative_least_squares(a, b);
  ASSERT_TRUE(x.has_value());
  EXPECT_NEAR((*x)[0], 1.5, 1e-14);  // rounding
  EXPECT_EQ((*x)[1], 0.0);
}

// Karush, Kuhn and Tucker: x >= 0, gradient <= 0, and 0 where x > 0.
TEST(Nnls, OptimalForRandomProblems) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(30, 12, [&] { return normal(random); });
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(30, [&] { return normal(random); });
    const auto x = nonnegative_least_squares(a, b);
    ASSERT_TRUE(x.has_value());
    const Eigen::VectorXd gradient = a.transpose() * (b - a * *x);
    for (Eigen::Index i = 0; i < x->size(); ++i) {
      EXPECT_GE((*x)[i], 0.0);
      EXPECT_LT(gradient[i], 1e-10);  // rounding
      if ((*x)[i] > 0.0) {
        EXPECT_NEAR(gradient[i], 0.0, 1e-10);  // likewise
      }
    }
  }
}

}  // namespace
}  // namespace palpate::fit
