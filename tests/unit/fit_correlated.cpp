// Intervals under correlated noise: how often they contain the truth.
#include "fit/correlated.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fit/regression.h"

namespace palpate::fit {
namespace {

// e_i = rho e_(i-1) + sqrt(1 - rho^2) z_i, of variance 1 from the start.
std::vector<double> noise_of(double rho, std::size_t count, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> noise{normal(random)};
  while (noise.size() < count)
    noise.push_back(rho * noise.back() + std::sqrt(1.0 - rho * rho) * normal(random));
  return noise;
}

struct Held {
  int amplitude = 0, time = 0;
};

// Relaxation with 400 points, fitted by `repeats` different noises.
Held held(double rho, int repeats, Residuals residuals) {
  std::mt19937_64 random(11);
  Held count;
  for (int k = 0; k < repeats; ++k) {
    const std::vector<double> noise = noise_of(rho, 400, random);
    std::vector<double> x, y;
    for (int i = 0; i < 400; ++i) {
      x.push_back(0.025 * i);
      y.push_back(1.0 + std::exp(-x.back() / 2.0) + 0.02 * noise[static_cast<std::size_t>(i)]);
    }
    const Fit fit = regress(x, y, Model::standard_linear_solid, {.residuals = residuals});
    const auto holds = [&](std::size_t i, double truth) {
      return fit.parameters[i].ci95_low < truth && truth < fit.parameters[i].ci95_high ? 1 : 0;
    };
    count.amplitude += holds(1, 2.0);
    count.time += holds(2, 2.0);
  }
  return count;
}

// Binomial standard deviation of 300 draws of 0.95: 3.8. docs/identify.md has the table.
TEST(Correlated, IntervalsHoldTheTruth) {
  for (const double rho : {0.0, 0.5, 0.9}) {
    const Held good = held(rho, 300, Residuals::correlated);
    EXPECT_GE(good.amplitude, 274) << rho;  // 285 minus three standard deviations
    EXPECT_LE(good.amplitude, 296) << rho;  // 285 plus three
    EXPECT_GE(good.time, 274) << rho;
    EXPECT_LE(good.time, 296) << rho;
  }
  // Taken as independent, the same residuals give intervals four times too narrow.
  EXPECT_LT(held(0.9, 100, Residuals::independent).time, 60);
}

TEST(Correlated, RhoIsFound) {
  std::mt19937_64 random(5);
  const std::size_t count = 4000;
  std::vector<double> ones(count, 1.0);
  for (const double rho : {0.5, 0.9}) {
    std::vector<double> residuals = noise_of(rho, count, random);
    const auto found = autocorrelation(residuals, ones, 1);
    ASSERT_TRUE(found.has_value());
    // Its standard deviation is sqrt((1 - rho^2) / n): 0.014 and 0.007.
    EXPECT_NEAR(found->rho, rho, 4.0 * std::sqrt((1.0 - rho * rho) / count));
    // The variance of a mean of n values: (1 + rho) / (1 - rho) / n, up to the error of rho.
    EXPECT_NEAR(found->covariance[0] * count * (1.0 - rho) / (1.0 + rho), 1.0, 0.3);
  }
}

TEST(Correlated, NothingWithoutCorrelation) {
  std::mt19937_64 random(6);
  int found = 0;
  const std::vector<double> ones(200, 1.0);
  for (int i = 0; i < 200; ++i)
    found += autocorrelation(noise_of(0.0, 200, random), ones, 1).has_value() ? 1 : 0;
  EXPECT_LE(found, 20);  // 5 % of 200 are 10, with a standard deviation of 3
  EXPECT_FALSE(autocorrelation(std::vector<double>(10, 1.0), std::vector<double>(10, 1.0), 1));
}

}  // namespace
}  // namespace palpate::fit
