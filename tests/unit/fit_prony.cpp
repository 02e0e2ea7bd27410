// Sums of exponentials out of curves whose truth is known.
#include "fit/prony.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace palpate::fit {
namespace {

struct RelaxationCurve {
  std::vector<double> x;
  std::vector<double> y;
};

// y = 3 + 2 e^(-t/0.1) + e^(-t/2), or the creep that climbs by the same terms; 0 to 8 s.
RelaxationCurve curve_of(PronySeries::Kind kind, int points = 400) {
  RelaxationCurve curve;
  for (int i = 0; i <= points; ++i) {
    const double t = 8.0 * i / points;
    const double fast = std::exp(-t / 0.1);
    const double slow = std::exp(-t / 2.0);
    curve.x.push_back(t);
    curve.y.push_back(kind == PronySeries::Kind::relaxation ? 3 + 2 * fast + slow
                                                            : 3 + 2 * (1 - fast) + (1 - slow));
  }
  return curve;
}

TEST(Prony, TwoTermsExactly) {
  for (const auto kind : {PronySeries::Kind::relaxation, PronySeries::Kind::creep}) {
    const RelaxationCurve curve = curve_of(kind);
    const Fit fit =
        fit_prony(curve.x, curve.y, {kind, 2}, {.x_unit = "s", .y_unit = "kPa", .x_origin = 0});
    EXPECT_EQ(word(fit.termination), "converged");
    const std::vector<std::string> names{kind == PronySeries::Kind::relaxation ? "y_inf" : "y_0",
                                         "y_1", "tau_1", "y_2", "tau_2"};
    const std::vector<std::string> units{"kPa", "kPa", "s", "kPa", "s"};
    const std::vector<double> truth{3, 2, 0.1, 1, 2};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_EQ(fit.parameters[i].name, names[i]);
      EXPECT_EQ(fit.parameters[i].unit, units[i]);
      EXPECT_NEAR(fit.parameters[i].estimate, truth[i], 1e-7);  // exact data, the solver's end
    }
  }
}

TEST(Prony, FromAnOriginAndInOtherUnits) {
  RelaxationCurve curve = curve_of(PronySeries::Kind::relaxation);
  for (double& x : curve.x) x = 1e3 * x + 500;
  for (double& y : curve.y) y *= 1e-6;
  const Fit fit = fit_prony(curve.x, curve.y, {}, {.x_unit = "ms", .x_origin = 500});
  EXPECT_NEAR(fit.parameters[2].estimate, 100, 1e-5);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 2e-6, 1e-13);
  EXPECT_DOUBLE_EQ(fit.range_low, 500);
}

TEST(Prony, MoreTermsThanThereAre) {
  const RelaxationCurve curve = curve_of(PronySeries::Kind::relaxation);
  const Fit fit = fit_prony(curve.x, curve.y, {PronySeries::Kind::relaxation, 1});
  EXPECT_LT(fit.r2, 0.99);  // one is too few
  RelaxationCurve single;
  for (int i = 0; i <= 100; ++i) {
    single.x.push_back(0.1 * i);
    single.y.push_back(1 + 2 * std::exp(-0.1 * i));
  }
  const Fit two = fit_prony(single.x, single.y, {});
  EXPECT_NEAR(two.rmse, 0.0, 1e-9);
  EXPECT_NE(word(two.termination), "failed");
  for (std::size_t i = 2; i < 5; i += 2) EXPECT_GT(two.parameters[i].estimate, 0.0);
  EXPECT_LE(two.parameters[2].estimate, two.parameters[4].estimate);
}

TEST(Prony, ThreeTermsInNoise) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.005);
  const std::vector<double> truth{1, 1, 0.05, 1, 0.7, 1, 6};
  std::vector<double> x, clean;
  for (int i = 0; i <= 1000; ++i) {  // as a test bench samples: densely first
    x.push_back(30.0 * std::pow(i / 1000.0, 3.0));
    double y = truth[0];
    for (std::size_t k = 1; k < 7; k += 2) y += truth[k] * std::exp(-x.back() / truth[k + 1]);
    clean.push_back(y);
  }
  // Of 60 draws of 0.95 some 57 hold; three of their deviations of 1.7 below that are 52.
  std::vector<int> held(truth.size(), 0);
  std::vector<double> sum(truth.size(), 0), squares(truth.size(), 0), said(truth.size(), 0);
  for (int repeat = 0; repeat < 60; ++repeat) {
    std::vector<double> y = clean;
    for (double& each : y) each += noise(random);
    const Fit fit = fit_prony(x, y, {PronySeries::Kind::relaxation, 3});
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Estimate& one = fit.parameters[i];
      held[i] += one.ci95_low < truth[i] && truth[i] < one.ci95_high ? 1 : 0;
      sum[i] += one.estimate / 60;
      squares[i] += one.estimate * one.estimate / 60;
      said[i] += one.std_error / 60;
    }
  }
  for (const int count : held) EXPECT_GE(count, 52);
  // The spread of 60 estimates is known to 1 / sqrt(120) = 9 %: three of these, and some for bias.
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double spread = std::sqrt(squares[i] - sum[i] * sum[i]);
    EXPECT_GT(said[i] / spread, 0.7) << i;
    EXPECT_LT(said[i] / spread, 1.4) << i;
  }
}

// More terms than the data hold pass each other on the way to the minimum.
TEST(Prony, TermsStandByRisingTime) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int repeat = 0; repeat < 40; ++repeat) {
    RelaxationCurve curve = curve_of(PronySeries::Kind::creep, 60);
    for (double& y : curve.y) y += noise(random);
    const Fit fit = fit_prony(curve.x, curve.y, {PronySeries::Kind::creep, 4});
    for (std::size_t i = 4; i < fit.parameters.size(); i += 2)
      EXPECT_LE(fit.parameters[i - 2].estimate, fit.parameters[i].estimate) << repeat;
  }
}

TEST(Prony, TooFewPoints) {
  const std::vector<double> few{1, 2, 3, 4, 5};
  try {
    static_cast<void>(fit_prony(few, few, {}));
    ADD_FAILURE() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "the model `prony` needs at least 6 points for this number of terms, and 5 are "
                 "usable; record more points, or give fewer `--terms`");
  }
}

// A Maxwell element with tau = 2 beside a spring, after a ramp of 1.5: as a step the same curve
// gives another amplitude.
TEST(Prony, RampAndHoldExactly) {
  const double tau = 2.0, ramp = 1.5;
  std::vector<double> x, y, history;
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.025 * i;
    x.push_back(t);
    // Boltzmann by hand: rate (y_inf t + y_1 tau (1 - e^(-t/tau))), and from the end of the ramp on
    // the same minus that of a ramp that begins then.
    const auto rising = [&](double s) {
      return s <= 0.0 ? 0.0 : (0.8 * s + 1.3 * tau * (1.0 - std::exp(-s / tau))) / ramp;
    };
    y.push_back(rising(t) - rising(t - ramp));
    history.push_back(0.07 * std::min(t / ramp, 1.0));
  }
  const auto expect = [&](const Fit& fit) {
    EXPECT_EQ(word(fit.termination), "converged");
    EXPECT_NEAR(fit.parameters[0].estimate, 0.8, 1e-9);  // exact data
    EXPECT_NEAR(fit.parameters[1].estimate, 1.3, 1e-9);  // likewise
    EXPECT_NEAR(fit.parameters[2].estimate, 2.0, 1e-9);  // likewise
  };
  PronySeries series{PronySeries::Kind::relaxation, 1};
  series.history.ramp = ramp;
  expect(fit_prony(x, y, series));
  series.history = {};
  series.history.samples = history;  // its bend at 1.5 is one of the points
  expect(fit_prony(x, y, series));
  const Fit step = fit_prony(x, y, {PronySeries::Kind::relaxation, 1});
  EXPECT_GT(std::abs(step.parameters[1].estimate - 1.3), 0.3);
}

TEST(Prony, RampInCreepExactly) {
  std::vector<double> x, y;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.05 * i;
    x.push_back(t);
    // Integral of J over the ramp: J = 0.2 + 0.5 (1 - e^(-t/3)).
    const auto rising = [](double s) {
      return s <= 0.0 ? 0.0 : 0.7 * s - 0.5 * 3.0 * (1.0 - std::exp(-s / 3.0));
    };
    y.push_back(rising(t) - rising(t - 1.0));
  }
  PronySeries series{PronySeries::Kind::creep, 1};
  series.history.ramp = 1.0;
  const Fit fit = fit_prony(x, y, series);
  EXPECT_NEAR(fit.parameters[0].estimate, 0.2, 1e-9);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 0.5, 1e-9);  // likewise
  EXPECT_NEAR(fit.parameters[2].estimate, 3.0, 1e-8);  // likewise
}

// 20 given times: no height is negative, and the curve of two exponentials is followed closely.
TEST(Prony, ManyTermsAreNotNegative) {
  std::vector<double> x, y;
  for (int i = 0; i <= 1000; ++i) {
    x.push_back(0.01 * i);
    y.push_back(1.0 + 2.0 * std::exp(-x.back() / 0.2) + std::exp(-x.back() / 2.0));
  }
  const Fit fit = fit_prony(x, y, {PronySeries::Kind::relaxation, 20});
  EXPECT_EQ(word(fit.termination), "converged");
  EXPECT_LT(fit.rmse, 2e-3);  // times a factor 1.44 apart
  double sum = 0.0;
  for (std::size_t i = 0; i < fit.parameters.size(); i += i == 0 ? 1 : 2) {
    EXPECT_GE(fit.parameters[i].estimate, 0.0);
    sum += fit.parameters[i].estimate;
  }
  EXPECT_NEAR(sum, 4.0, 0.02);  // y(0)
}

// A Maxwell liquid relaxes to 0, a Burgers liquid creeps on at a constant rate.
TEST(Prony, LiquidsExactly) {
  std::vector<double> x, fall, creep;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.05 * i;
    x.push_back(t);
    fall.push_back(1.3 * std::exp(-t / 2.0));
    creep.push_back(0.2 + 0.03 * t + 0.5 * (1.0 - std::exp(-t / 1.5)));
  }
  PronySeries series{PronySeries::Kind::relaxation, 1, true};
  Fit fit = fit_prony(x, fall, series, {.x_unit = "s", .y_unit = "kPa"});
  ASSERT_EQ(fit.parameters.size(), 2U);
  EXPECT_NEAR(fit.parameters[0].estimate, 1.3, 1e-9);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 2.0, 1e-9);  // likewise
  series.kind = PronySeries::Kind::creep;
  fit = fit_prony(x, creep, series, {.x_unit = "s"});
  ASSERT_EQ(fit.parameters.size(), 4U);
  EXPECT_EQ(fit.parameters[1].name + " " + fit.parameters[1].unit, "y_flow 1/s");
  for (const auto& [i, truth] :
       {std::pair{0U, 0.2}, std::pair{1U, 0.03}, std::pair{2U, 0.5}, std::pair{3U, 1.5}})
    EXPECT_NEAR(fit.parameters[i].estimate, truth, 1e-8) << i;  // exact data
}

// A row without a strain is excluded, like one without a stress.
TEST(Prony, ARowWithoutAHistoryIsLeftOut) {
  const RelaxationCurve curve = curve_of(PronySeries::Kind::relaxation);
  PronySeries series;
  series.history.samples.assign(curve.x.size(), 1.0);
  series.history.samples[200] = std::nan("");
  const Fit fit = fit_prony(curve.x, curve.y, series);
  EXPECT_EQ(fit.excluded, 1);
  EXPECT_NEAR(fit.parameters[4].estimate, 2.0, 1e-6);  // exact data
}

// y = y_0 H + y_flow int H + y_1 (1 - e^(-t/tau)) under a load that grows for 2 s: the terms'
// integrals over the ramp, divided by its duration.
TEST(Prony, ALiquidFlowsDuringTheRamp) {
  const double ramp = 2.0;
  const double tau = 1.5;
  RelaxationCurve curve;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.05 * i;
    const double load = std::min(t / ramp, 1.0);
    const double flow = t < ramp ? 0.5 * t * t / ramp : t - 0.5 * ramp;
    const double left = t < ramp ? tau / ramp * (1.0 - std::exp(-t / tau))
                                 : tau / ramp * std::expm1(ramp / tau) * std::exp(-t / tau);
    curve.x.push_back(t);
    curve.y.push_back(1.0 * load + 0.3 * flow + 2.0 * (load - left));
  }
  PronySeries series{PronySeries::Kind::creep, 1};
  series.liquid = true;
  series.history.ramp = ramp;
  const Fit fit = fit_prony(curve.x, curve.y, series);
  ASSERT_EQ(fit.parameters.size(), 4U);
  const std::vector<double> truth{1.0, 0.3, 2.0, tau};
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(fit.parameters[i].estimate, truth[i], 1e-6)
        << fit.parameters[i].name;  // exact data
}

}  // namespace
}  // namespace palpate::fit
