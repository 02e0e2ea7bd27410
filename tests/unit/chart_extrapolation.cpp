// Richardson's extrapolation: exact for powers, careful where numbers do not settle.
#include "chart/truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate::chart {
namespace {

std::vector<double> of_order(double order, double value, double factor,
                             const std::vector<double>& spacings) {
  std::vector<double> values;
  for (const double h : spacings) values.push_back(value + factor * std::pow(h, order));
  return values;
}

TEST(Extrapolate, is_exact_for_a_power_of_the_spacing) {
  for (const std::vector<double>& h :
       {std::vector<double>{1.0, 0.5, 0.25}, std::vector<double>{0.25, 0.2, 1.0 / 6.0},
        std::vector<double>{9.0, 1.0, 0.8, 0.5}})
    for (const double order : {0.6, 1.0, 1.7, 2.0, 2.9})
      for (const double factor : {0.3, -0.3}) {
        const auto found = extrapolate(h, of_order(order, 5.0, factor, h));
        EXPECT_NEAR(found.value, 5.0, 1e-9) << order;  // halves of the order's interval, magnified
        EXPECT_NEAR(found.order, order, 1e-8) << order;
        const double rest = std::abs(factor) * std::pow(h.back(), order);
        const double last =
            std::abs(factor) * (std::pow(h[h.size() - 2], order) - std::pow(h.back(), order));
        EXPECT_NEAR(found.error, std::max(rest, 0.5 * last), 1e-9);
      }
}

TEST(Extrapolate, what_swings_or_stops_at_once_keeps_the_finest_and_the_spread) {
  const std::vector<double> h{0.25, 0.2, 1.0 / 6.0};
  for (const std::vector<double>& values :
       {std::vector<double>{1.0, 3.0, 2.0}, std::vector<double>{1.0, 2.9, 3.0},
        std::vector<double>{3.0, 1.0, 1.0}}) {
    const auto found = extrapolate(h, values);
    EXPECT_EQ(found.value, values.back());
    EXPECT_DOUBLE_EQ(found.error, 2.0);
    EXPECT_EQ(found.order, 0.0);
  }
}

// Changes that hardly fall: p would be below 1/2. 1 -> 2 -> 3 with h 1, 1/2, 1/4: p = 1/2, and
// what is left is 1 / (sqrt(2) - 1).
TEST(Extrapolate, a_slow_approach_is_taken_as_of_order_one_half) {
  const std::vector<double> h{1.0, 0.5, 0.25};
  const auto found = extrapolate(h, std::vector<double>{1.0, 2.0, 3.0});
  EXPECT_NEAR(found.order, 0.5, 1e-9);
  EXPECT_NEAR(found.value, 3.0 + 1.0 / (std::sqrt(2.0) - 1.0), 1e-8);
  EXPECT_NEAR(found.error, 1.0 / (std::sqrt(2.0) - 1.0), 1e-8);
}

TEST(Extrapolate, two_values_count_as_of_first_order_and_one_as_nothing) {
  const std::vector<double> h{1.0, 0.5};
  const auto two = extrapolate(h, std::vector<double>{3.0, 2.0});
  EXPECT_DOUBLE_EQ(two.value, 1.0);
  EXPECT_DOUBLE_EQ(two.error, 2.0);
  const auto one = extrapolate(std::vector<double>{1.0}, std::vector<double>{3.0});
  EXPECT_EQ(one.value, 3.0);
  EXPECT_TRUE(std::isinf(one.error));
}

TEST(Extrapolate, numbers_that_are_the_same_are_sure) {
  const std::vector<double> h{1.0, 0.5, 0.25};
  const auto found = extrapolate(h, std::vector<double>{2.0, 2.0, 2.0});
  EXPECT_EQ(found.value, 2.0);
  EXPECT_EQ(found.error, 0.0);
}

}  // namespace
}  // namespace palpate::chart
