// Intervals under correlated noise: how often they contain the truth.
#include "fit/residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/numerics.h"
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
  double width = 0.0;  // mean of the intervals of the amplitude
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
    count.width += (fit.parameters[1].ci95_high - fit.parameters[1].ci95_low) / repeats;
  }
  return count;
}

// Binomial standard deviation of 300 draws of 0.95: 3.8. docs/identify.md has the table.
TEST(Correlated, IntervalsHoldTheTruth) {
  for (const double rho : {0.0, 0.5, 0.9}) {
    const Held good = held(rho, 300, Residuals::correlated);
    EXPECT_GE(good.amplitude, 274) << rho;  // 285 minus three standard deviations
    EXPECT_GE(good.time, 274) << rho;
    if (rho > 0.0) continue;
    EXPECT_LE(good.amplitude, 296);  // 285 plus three
    EXPECT_LE(good.time, 296);
  }
  // Taken as independent, the same residuals give intervals four times too narrow. The process is
  // not known to be of first order, which costs less than a factor of two.
  const Held narrow = held(0.9, 100, Residuals::independent);
  EXPECT_LT(narrow.time, 60);
  const double right = std::sqrt((1.0 + 0.9) / (1.0 - 0.9)) * narrow.width;
  EXPECT_GT(held(0.9, 100, Residuals::correlated).width, right);
  EXPECT_LT(held(0.9, 100, Residuals::correlated).width, 2.0 * right);
}

// Noise whose spectrum is 1/f up to the fastest frequency: waves of random size and phase, from a
// sixteenth of the lowest frequency of the record.
TEST(Correlated, FlickerNoiseIsHeld) {
  std::mt19937_64 random(41);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int rows = 256;
  constexpr int circle = 16 * rows;
  std::vector<double> sines;
  for (int i = 0; i < circle; ++i) sines.push_back(std::sin(2.0 * 3.14159265358979 * i / circle));
  int slope_held = 0;
  constexpr int repeats = 200;
  for (int k = 0; k < repeats; ++k) {
    std::vector<double> residuals(rows, 0.0);
    for (int j = 1; j <= circle / 2; ++j) {
      const double a = normal(random) / std::sqrt(j);
      const double b = normal(random) / std::sqrt(j);
      for (int i = 0; i < rows; ++i)
        residuals[static_cast<std::size_t>(i)] +=
            a * sines[static_cast<std::size_t>(i * j % circle)] +
            b * sines[static_cast<std::size_t>((i * j + circle / 4) % circle)];
    }
    // A straight line is fitted: its residuals and slope.
    double mean = 0.0, slope = 0.0, squares = 0.0;
    const auto x = [](int i) { return (i - 0.5 * (rows - 1)) / rows; };
    for (int i = 0; i < rows; ++i) {
      const double e = residuals[static_cast<std::size_t>(i)];
      mean += e / rows;
      slope += x(i) * e;
      squares += x(i) * x(i);
    }
    slope /= squares;
    dense::Rows jacobian(rows, 2);
    for (int i = 0; i < rows; ++i) {
      residuals[static_cast<std::size_t>(i)] -= mean + slope * x(i);
      jacobian.row(i) << 1.0, x(i);
    }
    const auto found = autocorrelation(residuals, jacobian);
    ASSERT_TRUE(found.has_value());
    const double t = numerics::student_t_quantile(0.975, found->degrees);
    slope_held += std::abs(slope) < t * std::sqrt(found->covariance(1, 1)) ? 1 : 0;
  }
  EXPECT_GE(slope_held, 181);  // 190 minus three standard deviations
}

TEST(Correlated, RhoIsFound) {
  std::mt19937_64 random(5);
  const std::size_t count = 4000;
  const dense::Rows ones = dense::Rows::Ones(count, 1);
  for (const double rho : {0.5, 0.9}) {
    std::vector<double> residuals = noise_of(rho, count, random);
    const auto found = autocorrelation(residuals, ones);
    ASSERT_TRUE(found.has_value());
    // Its standard deviation is sqrt((1 - rho^2) / n): 0.014 and 0.007.
    EXPECT_NEAR(found->rho, rho, 4.0 * std::sqrt((1.0 - rho * rho) / count));
    // The variance of a mean of n values is (1 + rho) / (1 - rho) / n. That other processes would
    // give the same residuals makes it larger, the width of the interval by less than three: of all
    // that can be fitted, a mean is what slow noise moves most.
    const double variance = found->covariance(0, 0) * count * (1.0 - rho) / (1.0 + rho);
    EXPECT_GT(variance, 0.7);
    EXPECT_LT(variance, 9.0);
  }
}

TEST(Correlated, NothingWithoutCorrelation) {
  std::mt19937_64 random(6);
  int found = 0;
  const dense::Rows ones = dense::Rows::Ones(200, 1);
  for (int i = 0; i < 200; ++i)
    found += autocorrelation(noise_of(0.0, 200, random), ones).has_value() ? 1 : 0;
  EXPECT_LE(found, 20);  // 5 % of 200 are 10, with a standard deviation of 3
  EXPECT_FALSE(autocorrelation(std::vector<double>(10, 1.0), dense::Rows::Ones(10, 1)));
}

}  // namespace
}  // namespace palpate::fit
