// Means of long records: nothing is lost of noise, corners and jumps stay where they are.
#include "identify/prepare_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace palpate::identify {
namespace {

constexpr std::size_t rows = 30000;  // 20 in each of 1500 blocks

AveragedRows means_of(const std::function<double(double)>& y, double noise = 0.0,
                      std::size_t count = rows) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  std::vector<double> x, values;
  for (std::size_t i = 0; i < count; ++i) {
    x.push_back(static_cast<double>(i) / static_cast<double>(count));
    values.push_back(y(x.back()) + noise * normal(engine));
  }
  return averaged(x, values);
}

TEST(Averaged, ALineIsHalvedNowhere) {
  const AveragedRows line = means_of([](double x) { return 3.0 * x; });
  ASSERT_EQ(line.x.size(), 1500U);
  for (std::size_t i = 0; i < 1500; ++i) {
    EXPECT_EQ(line.count[i], 20.0);
    EXPECT_NEAR(line.x[i], (20.0 * static_cast<double>(i) + 9.5) / rows, 1e-15);
    EXPECT_NEAR(line.y[i], 3.0 * line.x[i], 1e-14);
  }
}

// 4 standard errors are exceeded once in 16 000 times.
TEST(Averaged, NoiseIsNoBend) {
  for (const std::size_t count : {rows, std::size_t{6001}, std::size_t{4000}}) {
    const AveragedRows found = means_of([](double) { return 0.0; }, 1.0, count);
    EXPECT_LT(found.x.size(), 1510U) << count;
    EXPECT_EQ(std::accumulate(found.count.begin(), found.count.end(), 0.0), count);
  }
}

TEST(Averaged, AJumpIsBetweenTwoRows) {
  for (const std::size_t place : {15007U, 15013U, 15001U}) {
    const double jump = (static_cast<double>(place) - 0.5) / rows;
    const AveragedRows found = means_of([&](double x) { return x < jump ? 0.0 : 1.0; }, 0.01);
    for (std::size_t i = 0; i < found.y.size(); ++i) {
      const bool after = found.x[i] > jump;
      EXPECT_NEAR(found.y[i], after ? 1.0 : 0.0, 0.06) << place;  // no mean of both
    }
    EXPECT_LT(found.x.size(), 1530U);
  }
}

// A block of two or three rows is halved where its rows differ by a jump.
TEST(Averaged, AJumpIsBetweenTwoRowsOfAShortBlock) {
  for (const std::size_t each : {2U, 3U}) {
    const std::size_t count = each * 1500;
    const double jump = (static_cast<double>(750 * each + 1) - 0.5) / static_cast<double>(count);
    const AveragedRows found = means_of([&](double x) { return x < jump ? 0.0 : 1.0; }, 0.0, count);
    for (const double y : found.y) EXPECT_TRUE(y == 0.0 || y == 1.0) << each << ' ' << y;
    EXPECT_LE(found.y.size(), 1502U);
  }
}

// At the crests of n waves a block bends by (2 pi n / 1500)^2 / 16, against twice 1e-4.
TEST(Averaged, BendsBelowATenThousandthOfTheRangeStay) {
  const auto wave = [](double waves) {
    return means_of([=](double x) { return std::sin(2.0 * M_PI * waves * x); });
  };
  EXPECT_EQ(wave(1.0).x.size(), 1500U);
  EXPECT_EQ(wave(6.0).x.size(), 1500U);  // by 4e-5
  EXPECT_GT(wave(30.0).x.size(), 2500U);
}

// At its crests the wave bends by 1e-3 over a block, whose error is 1.7e-4.
TEST(Averaged, ABendOfSixErrorsIsNoNoise) {
  const AveragedRows found =
      means_of([](double x) { return std::sin(2.0 * M_PI * 30.0 * x); }, 3.7e-4);
  EXPECT_GT(found.x.size(), 1900U);
}

}  // namespace
}  // namespace palpate::identify
