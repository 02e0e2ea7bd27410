// Errors, ties and tests of residuals, on slopes that are known.
#include "identify/box_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fit/residuals.h"

namespace palpate::identify {
namespace {

Unknown unknown(const std::string& key, double low, double high, Unknown::Scale scale) {
  return {.key = key, .scale = scale, .unit = std::nullopt, .low = low, .high = high};
}

using dense::Matrix;
using dense::Rows;

// The covariance of independent residuals along two directions.
Matrix white(double sigma) { return sigma * sigma * Matrix::Identity(2, 2); }

// Two columns: sums of squares 4 and 1, orthogonal.
TEST(BoxErrors, AreThoseOfLinearLeastSquares) {
  const Rows slopes{{2.0, 0.0}, {0.0, 1.0}};
  const BoxErrors errors = box_errors(slopes, white(0.1), 2.0);
  EXPECT_EQ(errors.determined, 2);
  EXPECT_NEAR(errors.variance(0, 0), 0.01 / 4.0, 1e-15);  // rounding
  EXPECT_NEAR(errors.variance(1, 1), 0.01, 1e-15);
  EXPECT_NEAR(errors.variance(0, 1), 0.0, 1e-15);
  EXPECT_EQ(errors.inseparable, (std::vector<char>{0, 0}));
}

TEST(BoxErrors, CorrelatedColumnsShareTheirError) {
  // J^T J = [[2, 1], [1, 1]], its inverse [[1, -1], [-1, 2]].
  const Rows slopes{{1.0, 0.0}, {1.0, 1.0}};
  const BoxErrors errors = box_errors(slopes, white(0.1), 2.0);
  EXPECT_NEAR(errors.variance(0, 0), 0.01, 1e-15);  // rounding
  EXPECT_NEAR(errors.variance(0, 1), -0.01, 1e-15);
  EXPECT_NEAR(errors.variance(1, 1), 0.02, 1e-15);
}

// Noise that is larger along one direction reaches the unknown that this direction moves.
TEST(BoxErrors, FollowTheNoiseOfEachDirection) {
  const Rows slopes{{2.0, 0.0}, {0.0, 1.0}};
  const BoxErrors errors = box_errors(slopes, Matrix{{0.01, 0.003}, {0.003, 0.04}}, 2.0);
  EXPECT_NEAR(errors.variance(0, 0), 0.01 / 4.0, 1e-15);  // rounding
  EXPECT_NEAR(errors.variance(1, 1), 0.04, 1e-15);
  EXPECT_NEAR(std::abs(errors.variance(0, 1)), 0.003 / 2.0, 1e-15);
  EXPECT_NEAR(errors.of_one(0, 0), 1.0 / 4.0, 1e-15);
  EXPECT_NEAR(errors.of_one(1, 1), 1.0, 1e-15);
}

TEST(BoxErrors, ADirectionWiderThanHalfTheBoxIsATie) {
  const auto inseparable = [](double slope) {
    return box_errors(Rows{{1.0, 0.0}, {0.0, slope}}, white(0.1), 2.0).inseparable;
  };
  // 2 sigma / slope is 0.5 at 0.4
  EXPECT_EQ(inseparable(0.41), (std::vector<char>{0, 0}));
  EXPECT_EQ(inseparable(0.39), (std::vector<char>{0, 1}));
}

TEST(BoxErrors, OfAProductOnlyTheProductIsDetermined) {
  // The model a b^2, both over a factor of e^2 of the box: d ln / du = 2 and 2 * 2.
  const double range = std::exp(2.0);
  const std::vector<Unknown> unknowns{unknown("a", 1.0, range, Unknown::Scale::logarithmic),
                                      unknown("b", 1.0, range, Unknown::Scale::logarithmic)};
  const Rows slopes{{2.0, 4.0}, {4.0, 8.0}, {6.0, 12.0}};
  const BoxErrors errors = box_errors(slopes, Matrix{{1e-4}}, 2.0);
  EXPECT_EQ(errors.determined, 1);
  EXPECT_EQ(errors.inseparable, (std::vector<char>{1, 1}));
  const auto found = combination(errors, unknowns, std::vector{0.5, 0.25}, 2.0);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->text, "a * b^2");
  EXPECT_NEAR(found->estimate, std::exp(1.0) * std::exp(1.0), 1e-9);  // rounding
  // d ln(a b^2) = 2 du_a + 4 du_b, and a row says it with errors of sigma: over 1, 2 and 3 times.
  EXPECT_NEAR(found->std_error / found->estimate, 0.01 / std::sqrt(14.0), 1e-6);
}

// E / (1 - nu^2) is named only where the loose direction keeps it, and only of a Poisson's ratio.
TEST(BoxErrors, HertzsModulusIsNamedWhereItIsDetermined) {
  const auto text = [](const char* other, double slope) {
    const std::vector<Unknown> unknowns{
        unknown("tissue.young_modulus", 1e3, 1e5, Unknown::Scale::logarithmic),
        unknown(other, 0.2, 0.49, Unknown::Scale::linear)};
    const std::vector<double> u{0.5, 0.5};
    const BoxErrors errors =
        box_errors(Rows{{std::log(100.0), slope}, {0.0, 0.0}}, white(1e-3), 2.0);
    return combination(errors, unknowns, u, 2.0).value().text;
  };
  const double nu = 0.345;
  const double slope = 2.0 * nu / (1.0 - nu * nu) * 0.29;  // d ln(1 / (1 - nu^2)) / du
  EXPECT_EQ(text("tissue.poisson_ratio", slope),
            "tissue.young_modulus / (1 - tissue.poisson_ratio^2)");
  EXPECT_EQ(text("tissue.poisson_ratio", 2.0 * slope).find("1 - "), std::string::npos);
  EXPECT_EQ(text("tissue.shape.size.3", slope).find("1 - "), std::string::npos);
}

// Noise below a hundred-thousandth has no meaning, and neither has a slope below a millionth of the
// steepest; the weakest directions that are asked for are loose in any case.
TEST(BoxErrors, WhatIsTooSmallToCount) {
  EXPECT_EQ(box_errors(Rows{{2.0, 0.0}, {0.0, 1e-6}}, white(0.0), 2.0).inseparable,
            (std::vector<char>{0, 1}));
  EXPECT_EQ(determined_directions(Rows{{2.0, 0.0}, {0.0, 1e-8}}).cols(), 1);  // of two
  EXPECT_EQ(determined_directions(Rows{{2.0, 0.0}, {0.0, 1e-4}}).cols(), 2);
  const BoxErrors weakest = box_errors(Rows{{2.0, 0.0}, {0.0, 1.0}}, white(1e-3), 2.0, 1);
  EXPECT_EQ(weakest.determined, 1);
  EXPECT_EQ(weakest.inseparable, (std::vector<char>{0, 1}));
}

// Along a loose direction (1, s) the second unknown moves by s/2, which ties it only where that is
// more than a thousandth and more than its own error.
TEST(BoxErrors, ASmallPartOfALooseDirectionIsNoTie) {
  const auto inseparable = [](double s, double sigma) {
    return box_errors(Rows{{-s, 1.0}, {0.0, 0.0}}, white(sigma), 2.0).inseparable[1] != 0;
  };
  EXPECT_FALSE(inseparable(0.0005, 1e-5));
  EXPECT_FALSE(inseparable(0.01, 0.1));
  EXPECT_TRUE(inseparable(0.01, 1e-5));
}

TEST(ResidualTests, TellNoiseFromBends) {
  std::vector<double> alternating, bend;
  for (int i = 0; i < 40; ++i) {
    alternating.push_back(i % 2 == 0 ? 1.0 : -1.0);
    bend.push_back(i < 20 ? 1.0 : -1.0);
  }
  // 39 steps of 2, and one.
  EXPECT_DOUBLE_EQ(fit::durbin_watson(alternating), 39.0 * 4.0 / 40.0);
  EXPECT_DOUBLE_EQ(fit::durbin_watson(bend), 4.0 / 40.0);
  // 20 of each sign: mean 21, variance 20 * 19 / 39
  EXPECT_NEAR(fit::runs_z(bend), (2.0 - 21.0) / std::sqrt(20.0 * 19.0 / 39.0), 1e-12);
  EXPECT_TRUE(fit::systematic(bend));
  EXPECT_FALSE(fit::systematic(alternating));
}

}  // namespace
}  // namespace palpate::identify
