// Lines of equal value on grids, and round numbers for them.
#include "plot/contours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <regex>

#include "plot/gnuplot_text.h"

namespace palpate::plot {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
using Numbers = std::vector<double>;

TEST(Contours, RoundLevelsAreOneTwoAndFiveTimesAPowerOfTen) {
  EXPECT_EQ(round_levels(0.0, 1.0, 5, false), (Numbers{0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_EQ(round_levels(-3.0, 7.0, 5, false), (Numbers{-2.0, 0.0, 2.0, 4.0, 6.0}));
  EXPECT_EQ(round_levels(0.11, 0.19, 8, false),
            (Numbers{0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19}));
  EXPECT_EQ(round_levels(1200.0, 5100.0, 4, false), (Numbers{2000.0, 3000.0, 4000.0, 5000.0}));
  EXPECT_EQ(round_levels(0.004, 0.3, 8, true), (Numbers{0.005, 0.01, 0.02, 0.05, 0.1, 0.2}));
  EXPECT_EQ(round_levels(1e-3, 1e6, 4, true).size(), 10u);  // decades alone
  EXPECT_TRUE(round_levels(2.0, 2.0, 8, false).empty());
  EXPECT_TRUE(round_levels(none, none, 8, false).empty());
}

TEST(Contours, OfAPlaneAreStraightAndWhole) {
  ValueGrid grid{{0, 1, 3, 4}, {0, 2, 5}, {}};
  for (const double y : grid.y)
    for (const double x : grid.x) grid.values.push_back(x + 2.0 * y);
  const auto segments = contours(grid, Numbers{5.3});
  double length = 0.0;
  for (const Segment& one : segments) {
    EXPECT_EQ(one.level, 5.3);
    EXPECT_NEAR(one.x0 + 2.0 * one.y0, 5.3, 1e-14);  // linear interpolation is exact on a plane
    EXPECT_NEAR(one.x1 + 2.0 * one.y1, 5.3, 1e-14);
    length += std::hypot(one.x1 - one.x0, one.y1 - one.y0);
  }
  // From (0, 2.65) to (4, 0.65), in pieces that together leave nothing out.
  EXPECT_NEAR(length, std::hypot(4.0, 2.0), 1e-13);
}

TEST(Contours, LeaveOutCellsWithAnUnknownCorner) {
  const ValueGrid grid{{0, 1, 2}, {0, 1}, {0, 0, 0, 1, 1, none}};
  const auto segments = contours(grid, Numbers{0.5});
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_LE(std::max(segments[0].x0, segments[0].x1), 1.0);
}

TEST(Contours, ASaddleIsCutAsItsMiddleSays) {
  // The high corners are the lower left and the upper right; their lines cut off the low ones where
  // the middle is high, and themselves where it is low.
  const auto high = contours({{0, 1}, {0, 1}, {4, 0, 0, 4}}, Numbers{1.0});
  const auto low = contours({{0, 1}, {0, 1}, {4, 0, 0, 4}}, Numbers{3.0});
  ASSERT_EQ(high.size(), 2u);
  ASSERT_EQ(low.size(), 2u);
  const auto around = [](const Segment& one, double x, double y) {
    return std::hypot(0.5 * (one.x0 + one.x1) - x, 0.5 * (one.y0 + one.y1) - y) < 0.5;
  };
  EXPECT_TRUE(around(high[0], 1, 0) || around(high[1], 1, 0));
  EXPECT_TRUE(around(high[0], 0, 1) || around(high[1], 0, 1));
  EXPECT_TRUE(around(low[0], 0, 0) || around(low[1], 0, 0));
  EXPECT_TRUE(around(low[0], 1, 1) || around(low[1], 1, 1));
}

// The labels of an axis from `low` to `high`: `'0.01' 0.01`, but not `'' 0.02 1`.
std::size_t labels(const std::string& axis, double low, double high) {
  const std::string script = plot::gnuplot_logarithmic(axis, low, high);
  const std::regex label("'[^']+' ");
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(script.begin(), script.end(), label), {}));
}

TEST(Ticks, OfALogarithmicAxisHaveFiveLabels) {
  for (const double low : {1e-3, 2e-3, 5e-3})
    for (const double factor : {10.0, 30.0, 100.0, 400.0, 1e4, 1e6})
      EXPECT_GE(labels("y", low, low * factor), 5U) << low << " " << factor;
  EXPECT_LE(labels("x", 1e-3, 10.0), 5U) << "beside each other there is no room for more";
}

}  // namespace
}  // namespace palpate::plot
