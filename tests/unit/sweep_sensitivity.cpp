// Sobol indices against functions whose indices are known, of samples and of grids.
#include "sweep/sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "run/family.h"
#include "run/refined_mesh.h"
#include "run_text.h"
#include "scenario_text.h"

namespace palpate::sweep {
namespace {

using Function = std::function<double(std::span<const double>)>;
using Kind = scenario::Design::Kind;

// Blocks of a Saltelli design from independent points of the unit cube.
std::vector<double> saltelli_values(const Function& f, std::size_t d, std::size_t blocks,
                                    unsigned long long seed) {
  std::mt19937_64 generator(seed);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  std::vector<double> values;
  for (std::size_t j = 0; j < blocks; ++j) {
    std::vector<double> a(d), b(d);
    for (double& x : a) x = uniform();
    for (double& x : b) x = uniform();
    values.push_back(f(a));
    values.push_back(f(b));
    for (std::size_t i = 0; i < d; ++i) {
      std::vector<double> mixed = a;
      mixed[i] = b[i];
      values.push_back(f(mixed));
    }
  }
  return values;
}

// Ishigami and Homma 1990 with a = 7, b = 0.1, of the unit cube.
double ishigami(std::span<const double> u) {
  const auto x = [&](std::size_t i) { return std::numbers::pi * (2.0 * u[i] - 1.0); };
  return std::sin(x(0)) + 7.0 * std::pow(std::sin(x(1)), 2) +
         0.1 * std::pow(x(2), 4) * std::sin(x(0));
}
struct Truth {
  std::vector<double> first, total;
};
Truth ishigami_truth() {
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double v1 = 0.5 * std::pow(1.0 + 0.1 * pi4 / 5.0, 2);
  const double v2 = 49.0 / 8.0;
  const double v13 = 0.01 * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const double v = v1 + v2 + v13;
  return {{v1 / v, v2 / v, 0.0}, {(v1 + v13) / v, v2 / v, v13 / v}};
}

// Sobol's g-function: a product of factors (|4 u - 2| + a) / (1 + a).
const std::vector<double> weights{0.0, 1.0, 4.5, 9.0};
double g_function(std::span<const double> u) {
  double product = 1.0;
  for (std::size_t i = 0; i < u.size(); ++i)
    product *= (std::abs(4.0 * u[i] - 2.0) + weights[i]) / (1.0 + weights[i]);
  return product;
}
Truth g_truth() {
  double all = 1.0;
  std::vector<double> parts;
  for (const double a : weights) parts.push_back(1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
  for (const double part : parts) all *= 1.0 + part;
  Truth truth;
  for (const double part : parts) {
    truth.first.push_back(part / (all - 1.0));
    truth.total.push_back(part * all / (1.0 + part) / (all - 1.0));
  }
  return truth;
}

bool holds(const Share& share, double truth) { return share.low <= truth && truth <= share.high; }

TEST(Sensitivity, OfIshigamisFunctionLiesWithinItsIntervals) {
  const Truth truth = ishigami_truth();
  EXPECT_NEAR(truth.first[0], 0.3139, 5e-5);  // the published digits
  EXPECT_NEAR(truth.first[1], 0.4424, 5e-5);
  EXPECT_NEAR(truth.total[0], 0.5576, 5e-5);
  EXPECT_NEAR(truth.total[2], 0.2437, 5e-5);
  const auto found = saltelli_indices(saltelli_values(ishigami, 3, 4096, 3), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(holds(found[i].first, truth.first[i])) << i << " " << found[i].first.value;
    EXPECT_TRUE(holds(found[i].total, truth.total[i])) << i << " " << found[i].total.value;
  }
}

TEST(Sensitivity, IntervalsHoldTheTruthInNineteenOfTwentySamples) {
  const Truth truth = g_truth();
  int held = 0, all = 0;
  for (unsigned long long seed = 1; seed <= 60; ++seed) {
    const auto found = saltelli_indices(saltelli_values(g_function, 4, 300, seed), 4,
                                        {.resamples = 400, .seed = seed});
    for (std::size_t i = 0; i < 4; ++i) {
      held += holds(found[i].first, truth.first[i]) + holds(found[i].total, truth.total[i]);
      all += 2;
    }
  }
  // 480 intervals, in part of the same samples: 95 % within four standard errors of half of them:
  // wider ones would say as little as narrower ones.
  EXPECT_GT(held, 0.90 * all);
  EXPECT_LT(held, 0.99 * all);
}

TEST(Sensitivity, ConvergesAsTheRootOfTheBlocksAndDoesNotSeeALevel) {
  const Truth truth = g_truth();
  const auto raised = [](std::span<const double> u) { return 1e3 + g_function(u); };
  const auto error = [&](std::size_t blocks) {
    double sum = 0.0;
    for (unsigned long long seed = 1; seed <= 20; ++seed) {
      const auto found =
          saltelli_indices(saltelli_values(raised, 4, blocks, seed), 4, {.resamples = 0});
      for (std::size_t i = 0; i < 4; ++i)
        sum += std::pow(found[i].first.value - truth.first[i], 2) +
               std::pow(found[i].total.value - truth.total[i], 2);
    }
    return std::sqrt(sum / 160.0);
  };
  const double coarse = error(100);
  const double fine = error(1600);
  EXPECT_LT(coarse, 0.12);               // 1 / sqrt(100), times a little more than one
  EXPECT_NEAR(coarse / fine, 4.0, 1.6);  // sqrt(1600 / 100), of 20 samples of 8 numbers each
}

TEST(Sensitivity, IsTheSameTwiceAndNoNumberWithoutVariance) {
  const auto values = saltelli_values(ishigami, 3, 64, 5);
  const auto once = saltelli_indices(values, 3);
  const auto again = saltelli_indices(values, 3);
  EXPECT_EQ(once[1].first.low, again[1].first.low);
  EXPECT_EQ(once[2].total.high, again[2].total.high);
  const auto other = saltelli_indices(values, 3, {.seed = 2});
  EXPECT_NE(once[1].first.low, other[1].first.low);
  EXPECT_EQ(once[1].first.value, other[1].first.value);
  EXPECT_TRUE(std::isnan(saltelli_indices(std::vector<double>(20, 3.0), 3)[0].first.value));
}

TEST(Sensitivity, OfAGridIsExact) {
  // y = 3 a + 2 b + a b, a of -1, 0, 1 (variance 2/3) and b of -1, 1 (variance 1), c without a say.
  std::vector<double> values;
  for (const double a : {-1.0, 0.0, 1.0})
    for (int c = 0; c < 4; ++c)
      for (const double b : {-1.0, 1.0}) values.push_back(7.0 + 3.0 * a + 2.0 * b + a * b);
  const auto found = grid_indices(values, std::vector<std::size_t>{3, 4, 2});
  const double variance = 6.0 + 4.0 + 2.0 / 3.0;
  const double rounding = 1e-14;  // of 24 sums
  EXPECT_NEAR(found[0].first.value, 6.0 / variance, rounding);
  EXPECT_NEAR(found[0].total.value, (6.0 + 2.0 / 3.0) / variance, rounding);
  EXPECT_NEAR(found[1].first.value, 0.0, rounding);
  EXPECT_NEAR(found[1].total.value, 0.0, rounding);
  EXPECT_NEAR(found[2].first.value, 4.0 / variance, rounding);
  EXPECT_NEAR(found[2].total.value, (4.0 + 2.0 / 3.0) / variance, rounding);
  EXPECT_TRUE(std::isnan(found[0].first.low));
}

// The results of a sweep as a merge writes them, of one output.
SweepColumns columns_of(Kind kind, const std::vector<std::size_t>& levels,
                        std::vector<double> values) {
  SweepColumns columns{.kind = kind, .cases = values.size()};
  for (const std::size_t count : levels) {
    FactorColumn factor{
        .choice = {.name = "f" + std::to_string(columns.factors.size() + 1), .levels = count}};
    factor.values.assign(values.size(), 0.0);
    columns.factors.push_back(factor);
  }
  columns.outputs.push_back({"y", std::move(values)});
  return columns;
}

TEST(Sensitivity, OfHertzOverModulusAndRatioIsThatOfAProduct) {
  const std::string text =
      scenario::press +
      "[tissue]\nshape = { kind = \"half_space\" }\n[finger]\nmaterial = \"rigid\"\n"
      "[contact]\nviscosity = \"none\"\ndepth = \"hertz\"\n[solver]\nmodel = \"hertz\"\n"
      "[output]\nforce_at = [\"1 mm\"]\ninterval = \"10 ms\"\npressure_maps = false\n"
      "[sweep]\n\"tissue.young_modulus\" = [\"2 kPa\", \"10 kPa\", \"50 kPa\"]\n"
      "\"tissue.poisson_ratio\" = [0.1, 0.2, 0.3, 0.4]\n";
  const auto family = scenario::parse(text, "test.toml", {});
  std::vector<double> forces;
  for (const auto& one : family.cases) {
    const auto record = test::run_scene(run::build_scene(one, family));
    forces.push_back(std::get<double>(test::finding(record, "force_at_1_mm_N")));
  }
  ASSERT_EQ(forces.size(), 12u);
  // F = c E / (1 - nu^2): a product of independent g(E) and h(nu) has the variances
  // V_E = V(g) m(h)^2, V_nu = m(g)^2 V(h) and V_E,nu = V(g) V(h).
  const auto moments = [](const std::vector<double>& numbers) {
    double mean = 0.0, square = 0.0;
    for (const double one : numbers) {
      mean += one / static_cast<double>(numbers.size());
      square += one * one / static_cast<double>(numbers.size());
    }
    return std::pair{mean, square - mean * mean};
  };
  const auto [mean_e, variance_e] = moments({2, 10, 50});
  const auto [mean_nu, variance_nu] =
      moments({1 / (1 - 0.01), 1 / (1 - 0.04), 1 / (1 - 0.09), 1 / (1 - 0.16)});
  const double of_e = variance_e * mean_nu * mean_nu;
  const double of_nu = mean_e * mean_e * variance_nu;
  const double of_both = variance_e * variance_nu;
  const double all = of_e + of_nu + of_both;
  const Sensitivity found = sensitivity(columns_of(Kind::grid, {3, 4}, forces));
  ASSERT_EQ(found.indices.size(), 2u);
  const double rounding = 1e-12;  // of forces that have the same error of interpolation
  EXPECT_NEAR(found.indices[0].indices.first.value, of_e / all, rounding);
  EXPECT_NEAR(found.indices[0].indices.total.value, (of_e + of_both) / all, rounding);
  EXPECT_NEAR(found.indices[1].indices.first.value, of_nu / all, rounding);
  EXPECT_NEAR(found.indices[1].indices.total.value, (of_nu + of_both) / all, rounding);
}

TEST(Sensitivity, LeavesOutBlocksWithAFailedCaseAndSaysSo) {
  const double none = std::nan("");
  auto values = saltelli_values(ishigami, 3, 50, 1);
  auto shorter = values;
  values[12] = none;  // of the third block
  values[13] = none;
  values[201] = none;
  shorter.erase(shorter.begin() + 200, shorter.begin() + 205);
  shorter.erase(shorter.begin() + 10, shorter.begin() + 15);
  const Sensitivity found = sensitivity(columns_of(Kind::saltelli, {0, 0, 0}, values));
  ASSERT_EQ(found.indices.size(), 3u);
  EXPECT_EQ(found.indices[0].samples, 48u);
  EXPECT_EQ(found.indices[1].indices.first.value, saltelli_indices(shorter, 3)[1].first.value);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_EQ(found.notes[0].substr(0, 61),
            "sensitivity of `y`: 2 of 50 blocks of 5 cases are excluded, b");
}

TEST(Sensitivity, NeedsTwoCompleteBlocks) {
  auto values = saltelli_values(ishigami, 3, 2, 1);
  values[7] = std::nan("");
  const Sensitivity found = sensitivity(columns_of(Kind::saltelli, {0, 0, 0}, values));
  EXPECT_TRUE(found.indices.empty());
  ASSERT_EQ(found.notes.size(), 2u);
  EXPECT_EQ(found.notes[1],
            "sensitivity of `y`: at least two complete blocks are needed; run what is missing");
}

TEST(Sensitivity, OfAGridWithAGapIsRefusedWithARemedy) {
  const Sensitivity found =
      sensitivity(columns_of(Kind::grid, {2, 2}, {1.0, std::nan(""), 3.0, 4.0}));
  EXPECT_TRUE(found.indices.empty());
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_EQ(found.notes[0],
            "sensitivity of `y`: 1 of 4 cases have no value, and the indices of a grid need all; "
            "run what is missing, narrow the ranges to where cases complete, or take `design "
            "= \"saltelli\"`");
}

TEST(Sensitivity, OfOtherDesignsIsARankCorrelation) {
  SweepColumns columns = columns_of(Kind::lhs, {0, 0}, {1.0, 8.0, std::nan(""), 27.0, 64.0});
  columns.factors[0].values = {1, 2, 9, 3, 4};  // the cube of it, so that ranks agree
  columns.factors[1].values = {4, 3, 9, 2, 1};
  const Sensitivity found = sensitivity(columns);
  EXPECT_TRUE(found.indices.empty());
  ASSERT_EQ(found.correlations.size(), 2u);
  EXPECT_EQ(found.correlations[0].correlation, 1.0);
  EXPECT_EQ(found.correlations[1].correlation, -1.0);
  EXPECT_EQ(found.correlations[0].cases, 4u);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("`design = \"saltelli\"` gives indices"), std::string::npos);
}

TEST(Sensitivity, TiesShareTheirRank) {
  // Ranks 1, 2.5, 2.5, 4 and 1, 2, 3, 4: 4.5 / sqrt(4.5 * 5).
  EXPECT_DOUBLE_EQ(
      rank_correlation(std::vector<double>{5, 6, 6, 9}, std::vector<double>{1, 2, 3, 4}),
      4.5 / std::sqrt(4.5 * 5.0));
  EXPECT_TRUE(
      std::isnan(rank_correlation(std::vector<double>{5, 5, 5}, std::vector<double>{1, 2, 3})));
}

TEST(Sensitivity, TablesLeaveEmptyWhatIsNotKnown) {
  Sensitivity found;
  found.indices.push_back({"y", "x", {{0.5, 0.4, 0.6}, {0.7, std::nan(""), std::nan("")}}, 9});
  found.correlations.push_back({"y", "x", -0.25, 12});
  const record::Table table = sensitivity_table(found);
  EXPECT_EQ(
      std::get<double>(table.rows[0][static_cast<std::size_t>(table.find("first_order_low"))]),
      0.4);
  EXPECT_EQ(table.rows[0][static_cast<std::size_t>(table.find("total_low"))], record::Cell());
  EXPECT_EQ(std::get<double>(correlation_table(found).rows[0][2]), -0.25);
}

}  // namespace
}  // namespace palpate::sweep
