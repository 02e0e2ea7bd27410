// The layer's equation: how fast its points converge, and how fast its limits are reached.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/layer.h"
#include "layer_at_chi.h"

namespace palpate::contact {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Layer fixed{.poisson_ratio = 0.5, .base = LayerBase::bonded};
constexpr Layer fixed_soft{.poisson_ratio = 0.3, .base = LayerBase::bonded};
constexpr Layer sliding{.poisson_ratio = 0.5, .base = LayerBase::frictionless};

double difference(const LayerSolution& one, const LayerSolution& other) {
  return std::max({std::abs(one.depth / other.depth - 1.0), std::abs(one.force / other.force - 1.0),
                   std::abs(one.punch / other.punch - 1.0)});
}

// Faster than any power: every four points more are worth a factor of 30, and every 16 waves.
TEST(LayerEquation, ConvergesGeometrically) {
  for (const Layer& layer : {fixed, fixed_soft, sliding}) {
    const double ratio = 6.0;
    const LayerSolution exact = LayerEquation(layer, {.points = 100, .waves = 300}).solve(ratio);
    double before = 1.0;
    for (int points = 12; points <= 24; points += 4) {
      const double error =
          difference(LayerEquation(layer, {.points = points, .waves = 300}).solve(ratio), exact);
      EXPECT_LT(error, before / 30.0) << points << " points, nu " << layer.poisson_ratio;
      before = error;
    }
    EXPECT_LT(before, 1e-8);
    before = 1.0;
    for (int waves = 48; waves <= 80; waves += 16) {
      const double error =
          difference(LayerEquation(layer, {.points = 100, .waves = waves}).solve(ratio), exact);
      EXPECT_LT(error, before / 30.0) << waves << " waves, nu " << layer.poisson_ratio;
      before = error;
    }
    EXPECT_LT(before, 1e-10);
  }
}

// What `layer_resolution` promises, against twice as many points and waves.
TEST(LayerEquation, ResolvesWhatItSays) {
  for (const Layer& layer : {fixed, fixed_soft, sliding})
    for (const double ratio : {0.0, 0.1, 1.0, 3.0, 6.0, 10.0, 20.0, 40.0}) {
      const LayerResolution coarse = layer_resolution(ratio);
      const LayerSolution fine =
          LayerEquation(layer, {.points = 2 * coarse.points, .waves = 2 * coarse.waves})
              .solve(ratio);
      const double error = difference(LayerEquation(layer, coarse).solve(ratio), fine);
      EXPECT_LT(error, ratio <= 6.0 ? 1e-10 : 1e-8) << "a/H " << ratio;
    }
}

// The pressure's polynomial ends where its terms are below 1e-8.
TEST(LayerEquation, PressureSeriesEnds) {
  const PressureProfile profile = LayerEquation(fixed, layer_resolution(6.0)).solve(6.0).pressure;
  for (std::size_t k = PressureProfile::terms - 2; k < PressureProfile::terms; ++k)
    EXPECT_LT(std::abs(profile.coefficients[k]), 1e-8);
  for (std::size_t k = 6; k + 6 < PressureProfile::terms; ++k)  // on its way there
    EXPECT_LT(std::abs(profile.coefficients[k + 6]), 0.1 * std::abs(profile.coefficients[2]));
}

// f - 1 - c1 chi - 7/6 c1^2 chi^2 is of third order.
TEST(LayerEquation, SeriesIsOfThirdOrder) {
  for (const Layer& layer : {fixed, fixed_soft, sliding}) {
    const double c1 = test::layer_first_coefficient(layer);
    const LayerEquation equation(layer, layer_resolution(0.1));
    const auto rest = [&](double chi) {
      return test::layer_at_chi(equation, chi).force_factor() - 1.0 - c1 * chi -
             7.0 / 6.0 * c1 * c1 * chi * chi;
    };
    // The next term changes the ratio 8 by some chi.
    EXPECT_NEAR(rest(0.04) / rest(0.02), 8.0, 0.4);
    EXPECT_NEAR(rest(0.01) / rest(0.005), 8.0, 0.1);
  }
}

// A thin layer of a compressible tissue is a bed of springs: under a flat punch F = M pi a^2 h / H,
// so that kappa grows by pi/2 M / E* for each a/H; M / E* = (1 - nu)^2 / (1 - 2 nu) where the base
// holds, and 1 where both faces slide.
TEST(ThinLayer, BecomesABedOfSprings) {
  const auto slope = [](const Layer& layer, double ratio) {
    return (test::flat_punch_factor(2.0 * ratio, layer) - test::flat_punch_factor(ratio, layer)) /
           ratio;
  };
  const double springs = pi / 2.0 * 0.7 * 0.7 / 0.4;
  const double coarse = slope(fixed_soft, 5.0) - springs, fine = slope(fixed_soft, 20.0) - springs;
  EXPECT_LT(std::abs(fine), std::abs(coarse) / 4.0);
  EXPECT_NEAR(fine, 0.0, 1e-3 * springs);
  // The edge costs a constant and 1/ratio: a quarter with each doubling.
  const double first = slope(sliding, 5.0) - pi / 2.0, second = slope(sliding, 10.0) - pi / 2.0,
               third = slope(sliding, 20.0) - pi / 2.0;
  EXPECT_NEAR(first / second, 4.0, 0.5);
  EXPECT_NEAR(second / third, 4.0, 0.3);
  // Under a sphere h = a^2 / (2R).
  EXPECT_NEAR(test::solve_layer(40.0, sliding).depth, 0.5, 0.005);
}

// One that keeps its volume must flow outwards between base and punch. By lubrication theory, with
// the pressure 3 G h (a^2 - r^2) / (4 H^3) where the punch slides, kappa is 3 pi / 64 (a/H)^3.
TEST(ThinLayer, OfConstantVolumeResistsWithTheThirdPower) {
  const auto kappa = [](double ratio) { return test::flat_punch_factor(ratio, fixed); };
  const auto third_power = [&](double step) {  // from the third difference: an edge adds a square
    return (kappa(4.0 * step) - 3.0 * kappa(3.0 * step) + 3.0 * kappa(2.0 * step) - kappa(step)) /
           (6.0 * step * step * step);
  };
  const double expected = 3.0 * pi / 64.0;
  const double coarse = third_power(2.5) - expected, fine = third_power(10.0) - expected;
  EXPECT_LT(std::abs(fine), std::abs(coarse) / 10.0);
  EXPECT_NEAR(fine, 0.0, 1e-3 * expected);
}

}  // namespace
}  // namespace palpate::contact
