// The first guess of a search lies beside the truth, whatever the scale.
#include "fit/regression.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fit {
namespace {

TEST(Initial, ShapeIsWithinOneStepOfTheGrid) {
  for (const ModelInfo& row : models()) {
    if (!has_shape(row.model)) continue;
    for (const double unit : {1e-3, 1.0, 1e4})  // of x
      for (const double shape : {0.3, 1.1, 2.6}) {
        const bool is_power = row.model == Model::power;
        const bool is_rate = row.model == Model::exponential;
        const double truth = is_power ? shape : is_rate ? shape / unit : shape * unit;
        std::vector<double> parameters(static_cast<std::size_t>(term_count(row.model)), 0.5);
        parameters.back() = 2.0;
        parameters.push_back(truth);
        std::vector<double> x, y;
        for (int i = 1; i <= 30; ++i) {
          x.push_back(0.1 * i * unit);
          y.push_back(value(row.model, parameters, x.back()));
        }
        const auto guess = initial_guess(x, y, row.model);
        ASSERT_TRUE(guess.has_value());
        const double off = is_power ? std::abs(guess->back() - truth) / 0.25
                                    : 8.0 * std::abs(std::log10(guess->back() / truth));
        EXPECT_LT(off, 1.0) << row.name;  // the grid: 0.25, or eight steps a decade
      }
  }
}

TEST(Initial, NothingWhereNothingCanBeEvaluated) {
  const std::vector<double> x{-1.0, -2.0, -3.0}, y{1.0, 2.0, 3.0};
  EXPECT_FALSE(initial_guess(x, y, Model::logarithmic).has_value());  // ln of a negative number
}

TEST(Initial, DoesNotDependOnThePointsBefore) {
  const std::vector<double> some{0.1, 0.2, 0.4, 0.9}, others{1.0, 2.0, 3.0, 4.0}, fewer{0.1, 0.2};
  const std::vector<double> y{1.0, 1.9, 4.2, 8.7};
  for (const ModelInfo& row : models()) {
    const auto first = initial_guess(some, y, row.model);
    (void)initial_guess(others, y, row.model);
    EXPECT_EQ(initial_guess(some, y, row.model), first) << row.name;
    (void)initial_guess(fewer, std::span(y).first(2), row.model);
    EXPECT_EQ(initial_guess(some, y, row.model), first) << row.name;
  }
}

}  // namespace
}  // namespace palpate::fit
