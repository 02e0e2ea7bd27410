// Steps, cycles, ruptures and laws of two directions in curves whose truth is known.
#include "fit/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "base/index.h"
#include "base/text.h"
#include "fit/uniaxial.h"
#include "refusal.h"

namespace palpate::fit {
namespace {

struct Rows {
  std::vector<double> x, y;
};
// A relaxation 1 + e^(-t/2) after a step at `step`, with rows every 0.1 from `first`.
Rows relaxation(double first, double step) {
  Rows rows;
  for (int i = 0; i < 100; ++i) {
    const double t = first + 0.1 * i;
    rows.x.push_back(t);
    rows.y.push_back(t < step - 1e-9 ? 0.0 : 1.0 + std::exp(-(t - step) / 2.0));
  }
  return rows;
}

TEST(StepOrigin, OfARelaxation) {
  const auto at = [](double first, double step) {
    const Rows rows = relaxation(first, step);
    return step_origin(rows.x, rows.y, AfterStep::relaxes, 0.0);
  };
  EXPECT_EQ(at(0.0, 0.0).sentence, "");  // the clock's zero
  EXPECT_EQ(at(0.1, 0.0).sentence, "");  // one row before the first
  EXPECT_NEAR(at(30.0, 30.0).best.time, 30.0, 1e-9);
  EXPECT_NEAR(at(0.0, 2.0).best.time, 2.0, 1e-9);
  EXPECT_NEAR(at(0.0, 2.0).best.first, 2.0, 1e-9);
}

// Rheometers count the time from the step and space their rows by a factor, also by a small one
// that is written with three digits. Even spacing is none, however late the clock begins.
TEST(StepOrigin, OfTimesThatAreSpacedByAFactor) {
  const auto sentence = [](const std::vector<double>& x) {
    std::vector<double> y;
    for (const double t : x) y.push_back(3.0 * std::pow(t, -0.2));
    const StepOrigin found = step_origin(x, y, AfterStep::relaxes, 0.0);
    EXPECT_EQ(found.sentence.starts_with("the times are spaced"), found.best.time == 0.0);
    return found.sentence;
  };
  for (const int rows : {20, 200}) {
    std::vector<double> x;
    for (int i = 0; i < rows; ++i) {
      const double t = std::pow(10.0, -2.0 + 4.0 * i / (rows - 1));
      const double digit = std::pow(10.0, std::floor(std::log10(t)) - 2.0);
      x.push_back(digit * std::round(t / digit));
    }
    EXPECT_TRUE(sentence(x).starts_with("the times are spaced by a factor")) << rows;
  }
  for (const double first : {3.0, 30.0, 300.0}) {
    std::vector<double> x;
    for (int i = 0; i < 12; ++i) x.push_back(first + 0.1 * first * i);
    EXPECT_TRUE(sentence(x).starts_with("the record begins at")) << first;
  }
}

// Creep that rises out of the noise only after many rows, at times since its step: the strain at
// once is no level before it.
TEST(StepOrigin, OfACreepWhoseTimesAreSpacedByAFactor) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.02);
    Rows rows;
    for (int i = 0; i < 120; ++i) {
      const double t = std::pow(10.0, -1.0 + 3.7 * i / 119.0);
      rows.x.push_back(t);
      rows.y.push_back(2.0 + 1.1 * (1.0 - std::exp(-t / 2.0)) + 1.7 * (1.0 - std::exp(-t / 60.0)) +
                       noise(random));
    }
    const StepOrigin found = step_origin(rows.x, rows.y, AfterStep::rises, 0.0);
    EXPECT_TRUE(found.best.time == 0.0 && !found.after_level) << seed << ": " << found.best.time;
  }
}

TEST(StepOrigin, ACreepThatBeganBeforeTheRecordIsRefused) {
  std::vector<double> x, y;
  for (int i = 0; i < 50; ++i) {
    x.push_back(30.0 + i);
    y.push_back(1.0 - std::exp(-(10.0 + i) / 20.0));
  }
  EXPECT_TRUE(
      test::refusal([&] {
        return step_origin(x, y, AfterStep::rises_from_zero, 0.0);
      }).starts_with("the first row, at 30, is not near zero, so that the creep began before"));
}

// A ramp of stress from 2 to 5, and a hold: its ends to a row, with noise, whose largest value lies
// some rows from the end.
TEST(StepOrigin, OfARampIsItsBeginning) {
  const auto rows_with = [](double scatter) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, scatter);
    Rows rows;
    for (int i = 0; i < 300; ++i) {
      const double t = 0.1 * i + 0.03;
      rows.x.push_back(t);
      rows.y.push_back(noise(random) + (t < 2.0   ? 0.0
                                        : t < 5.0 ? t - 2.0
                                                  : 1.0 + 2.0 * std::exp(-(t - 5.0) / 4.0)));
    }
    return rows;
  };
  const Rows rows = rows_with(0.02);
  const StepOrigin found = step_origin(rows.x, rows.y, AfterStep::relaxes, std::nullopt);
  EXPECT_NEAR(found.best.time, 2.0, 0.11);
  EXPECT_NEAR(found.best.time + found.best.ramp, 5.0, 0.11);
  EXPECT_EQ(found.best.first, found.best.time + found.best.ramp);
  // The end may be a row earlier; the beginning and the end may be a row later.
  ASSERT_EQ(found.others.size(), 2U);
  EXPECT_NEAR(found.others[0].time, found.best.time, 1e-9);
  EXPECT_NEAR(found.others[0].ramp, found.best.ramp - 0.1, 1e-9);
  EXPECT_NEAR(found.others[1].time, found.best.time + 0.1, 1e-9);
  EXPECT_NEAR(found.others[1].ramp, found.best.ramp, 1e-9);
  EXPECT_EQ(step_origin(rows.x, rows.y, AfterStep::relaxes, 0.0).best.ramp, 0.0);
  const Rows noisy = rows_with(0.1);
  const Loading ramp = step_origin(noisy.x, noisy.y, AfterStep::relaxes, std::nullopt).best;
  EXPECT_NEAR(ramp.time + ramp.ramp, 5.0, 0.21);
}

// Three steps of strain, and the relaxation after each, are no ramp; a slow rise with noise is one.
TEST(StepOrigin, SeveralStepsAreNoRamp) {
  const auto rows_with = [](double relaxes, double scatter) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, scatter);
    Rows rows;
    for (int i = 0; i < 600; ++i) {
      const double t = 0.5 * i;
      double y = noise(random);
      for (const double step : {5.25, 100.25, 200.25})
        if (t > step) y += 2.0 + relaxes * std::exp(-(t - step) / 14.0);
      rows.x.push_back(t);
      rows.y.push_back(y);
    }
    return rows;
  };
  for (const double sign : {1.0, -1.0}) {
    Rows steps = rows_with(1.5, 0.02);
    for (double& each : steps.y) each *= sign;
    EXPECT_EQ(test::refusal(
                  [&] { return step_origin(steps.x, steps.y, AfterStep::relaxes, std::nullopt); }),
              "the load falls by over 10 % from 5.5 on, and is largest at 200.5, so that it has "
              "several steps or cycles; choose the rows of one by `--rows`, or give the measured "
              "loading by `--history`");
  }
  const Rows stairs = rows_with(0.0, 0.3);  // 10 % of a step are noise
  EXPECT_NO_THROW((void)step_origin(stairs.x, stairs.y, AfterStep::relaxes, std::nullopt));
}

// One row on the ramp is enough, and none is a step.
// A record that begins half-way up a ramp of 2 s: its line leads back to the beginning.
TEST(StepOrigin, OfARampThatTheRecordMissesInPart) {
  Rows rows;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    rows.x.push_back(5.0 + t);
    rows.y.push_back(t < 1.0 ? 1.0 + t : 1.0 + std::exp(-(t - 1.0) / 3.0));
  }
  const Loading found = step_origin(rows.x, rows.y, AfterStep::relaxes, std::nullopt).best;
  EXPECT_NEAR(found.time, 4.0, 0.02);  // its end is found to a fifth of a row
  EXPECT_NEAR(found.ramp, 2.0, 0.02);
}

TEST(StepOrigin, OfAShortRamp) {
  const std::vector<double> x{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0};
  std::vector<double> y{0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 1.8, 1.65, 1.55, 1.5};
  const Loading ramp = step_origin(x, y, AfterStep::relaxes, std::nullopt).best;
  EXPECT_EQ(ramp.time, 4.0);
  EXPECT_EQ(ramp.ramp, 2.0);
  y[4] = 0.0;
  EXPECT_EQ(step_origin(x, y, AfterStep::relaxes, std::nullopt).best.ramp, 0.0);
}

// A slow rise after a level, and the same rise from the first row on, whose clock is right.
TEST(StepOrigin, ALevelIsNoSlowStart) {
  std::normal_distribution<double> noise(0.0, 0.005);
  for (const double start : {8.03, 0.0})
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      Rows rows;
      for (int i = 0; i < 240; ++i) {
        const double t = 0.25 * i;
        rows.x.push_back(t);
        rows.y.push_back(noise(random) +
                         (t < start ? 0.0 : 0.2 * (1.0 - std::exp(-(t - start) / 8.0))));
      }
      const StepOrigin found = step_origin(rows.x, rows.y, AfterStep::rises_from_zero, 0.0);
      if (start == 0.0) {
        EXPECT_LT(found.best.time, 2.0) << seed;  // as late as noise makes it, for refined()
      } else {
        EXPECT_TRUE(found.after_level && !found.sentence.empty()) << seed;
      }
    }
}

TEST(StepOrigin, FewOrEvenTimesAreNotSpacedByAFactor) {
  const auto sentence = [](const std::vector<double>& x) {
    std::vector<double> y;
    for (const double t : x) y.push_back(3.0 * std::pow(t, -0.2));
    return step_origin(x, y, AfterStep::relaxes, 0.0).sentence;
  };
  EXPECT_TRUE(sentence({4.0, 6.0, 9.0, 13.5, 20.25}).starts_with("the record begins at 4"));
  EXPECT_TRUE(sentence({4.0, 6.0, 9.0, 13.5, 20.25, 30.375}).starts_with("the times are spaced"));
  std::vector<double> even;
  for (int i = 0; i < 60; ++i) even.push_back(3.0 + 0.3 * i);
  EXPECT_TRUE(sentence(even).starts_with("the record begins at 3"));
}

// A level has four rows, and may drift by less than 2 % of the whole.
TEST(StepOrigin, WhatIsALevel) {
  const auto found = [](int level, double drift) {
    Rows rows;
    for (int i = 0; i < 40; ++i) {
      rows.x.push_back(10.0 + i);
      rows.y.push_back(i < level ? drift * i : 1.0 + 0.5 * (i - level));
    }
    return step_origin(rows.x, rows.y, AfterStep::rises, 0.0);
  };
  EXPECT_FALSE(found(3, 0.0).after_level);
  EXPECT_TRUE(found(4, 0.0).after_level);
  EXPECT_EQ(found(8, 0.01).best.first, 18.0);  // the first row after it; the rise is 16.5
}

// A ramp needs a hold after it and a load before it that is small against its end.
TEST(StepOrigin, WhatIsNoRamp) {
  const auto ramp_of = [](const std::vector<double>& y) {
    std::vector<double> x;
    for (std::size_t i = 0; i < y.size(); ++i) x.push_back(5.0 + static_cast<double>(i));
    return step_origin(x, y, AfterStep::relaxes, std::nullopt).best.ramp;
  };
  EXPECT_EQ(ramp_of({0, 0, 0, 0, 0, 1, 2, 3, 4, 5}), 0.0);
  EXPECT_EQ(ramp_of({0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 4.9}), 0.0);
  EXPECT_EQ(ramp_of({0.9, 0.95, 1.0, 0.8, 0.7, 0.65, 0.6, 0.58, 0.57, 0.56}), 0.0);
  EXPECT_GT(ramp_of({0.0, 0.5, 1.0, 0.8, 0.7, 0.65, 0.6, 0.58, 0.57, 0.56}), 1.5);
  // Its first row is at most four fifths of its end.
  EXPECT_GT(ramp_of({0.79, 0.9, 1.0, 0.8, 0.7, 0.65, 0.6, 0.58, 0.57, 0.56}), 1.5);
  EXPECT_EQ(ramp_of({0.81, 0.9, 1.0, 0.8, 0.7, 0.65, 0.6, 0.58, 0.57, 0.56}), 0.0);
}

// What begins within a row's distance of the clock's zero begins there.
TEST(StepOrigin, TheClocksZero) {
  Rows rows;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.03 + 0.1 * i;
    rows.x.push_back(t);
    rows.y.push_back(t < 3.0 ? t : 1.0 + 2.0 * std::exp(-(t - 3.0) / 4.0));
  }
  EXPECT_EQ(step_origin(rows.x, rows.y, AfterStep::relaxes, std::nullopt).best.time, 0.0);
  // A distance of 1.9 before the step, and of 0.1 after it.
  const std::vector<double> x{-3.0, -2.0, -1.0, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4};
  const std::vector<double> y{0.0, 0.0, 0.0, 3.0, 2.8, 2.7, 2.6, 2.5, 2.45};
  EXPECT_EQ(step_origin(x, y, AfterStep::relaxes, 0.0).best.time, 0.0);
  // Of a ramp whose end is the first row.
  const Rows late = relaxation(0.0, 0.0);
  const StepOrigin found = step_origin(late.x, late.y, AfterStep::relaxes, 1.0);
  EXPECT_EQ(found.best.time, 0.0);
  EXPECT_EQ(found.sentence, "");
}

// The moment whose squares are least, and the ends at which they are as many more as the rows that
// count as one independent row allow.
TEST(StepOrigin, IsRefinedToTheLeastSquares) {
  const auto refined_at = [](double first, double least, double curvature, double rows_each) {
    Rows rows;
    for (int i = 0; i < 200; ++i) {
      rows.x.push_back(first + 0.1 * i);
      rows.y.push_back(i < 50 ? 0.0 : 0.02 * (i - 50));
    }
    StepOrigin coarse;
    coarse.best.first = rows.x[55];
    return refined(coarse, rows.x, rows.y, [&](const Loading& loading) {
      const double away = loading.time - least;
      return std::optional(Misfit{1.0 + curvature * away * away, rows_each, 3});
    });
  };
  // Within the rows up to 55 the level's own squares are 2e-4 at most.
  const StepOrigin one = refined_at(10.0, 15.1, 0.5, 1.0);
  EXPECT_NEAR(one.best.time, 15.1, 0.05);
  ASSERT_EQ(one.others.size(), 2U);
  const StepOrigin four = refined_at(10.0, 15.1, 0.5, 4.0);
  const double narrow = one.best.time - one.others[0].time;
  EXPECT_NEAR((four.best.time - four.others[0].time) / narrow, 2.0, 0.2);
  const StepOrigin clock = refined_at(-5.0, 0.1, 0.5, 1.0);
  EXPECT_EQ(clock.best.time, 0.0);
  EXPECT_EQ(clock.sentence, "");
}

// Without a fit there is nothing to refine, and what the rows leave open may lie before them.
TEST(StepOrigin, MayLieBeforeTheRecord) {
  EXPECT_FALSE(misfit_of([] {
                 Fit fit;
                 fit.termination = Termination::not_converged;
                 return fit;
               }).has_value());
  Rows rows;
  for (int i = 0; i < 40; ++i) {
    rows.x.push_back(10.0 + i);
    rows.y.push_back(i < 5 ? 0.0 : 0.2 * (i - 4));
  }
  StepOrigin coarse;
  coarse.best.first = rows.x[5];
  const StepOrigin open = refined(coarse, rows.x, rows.y, [](const Loading&) {
    return std::optional(Misfit{100.0, 1.0, 3});
  });
  ASSERT_EQ(open.others.size(), 2U);
  EXPECT_EQ(open.others[0].time, 9.0);  // one row before the first
}

TEST(StepOrigin, TheRowsBeforeARecovery) {
  const auto rows_of = [](const std::vector<double>& y) {
    std::vector<double> x;
    for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i));
    return rows_before_recovery(x, y);
  };
  EXPECT_EQ(rows_of({}), 0U);
  // Slack at the beginning is none.
  std::vector<double> slack{0.0, 0.01, 0.0, 0.0, 0.0, 0.0};
  for (int i = 1; i <= 90; ++i) slack.push_back(i / 90.0);
  EXPECT_EQ(rows_of(slack), 96U);
  std::vector<double> whole;
  for (int i = 0; i <= 40; ++i) whole.push_back(1.0 - std::exp(-i / 5.0));
  for (int i = 1; i <= 40; ++i) whole.push_back(std::exp(-i / 5.0));
  EXPECT_EQ(rows_of(whole), 41U);
  EXPECT_EQ(rows_of({0, 0.6, 0.8, 0.9, 1, 1, 1, 1, 0.5}), 8U);  // the last row alone
  // Nor is noise of a third.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.3);
  std::vector<double> y{0.0};
  for (int i = 0; i < 200; ++i) y.push_back(1.0 + noise(random));
  EXPECT_EQ(rows_of(y), 201U);
  EXPECT_EQ(fit::noise_of(std::vector<double>{0.0, 1.0, 0.0, 1.0}), 0.0);  // of fewer than five
}

// Creep that has come to its end is as large for long before the load is taken off.
TEST(StepOrigin, OfARecoveryIsTheEndOfThePlateau) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  Rows rows;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.1 * i;
    rows.x.push_back(t);
    rows.y.push_back(noise(random) +
                     (t < 20.0 ? 1.0 - std::exp(-t / 2.0) : std::exp(-(t - 20.0) / 2.0)));
  }
  const StepOrigin found = step_origin(rows.x, rows.y, AfterStep::recovers, 0.0);
  ASSERT_EQ(found.others.size(), 2U);  // a row earlier or later
  EXPECT_NEAR(found.others[1].time - found.best.time, 0.1, 1e-9);
  EXPECT_NEAR(found.best.time, 20.0, 0.21);
}

TEST(LoadingPart, ALimitIsARunOfTheLargestValue) {
  std::vector<double> y;
  for (int i = 0; i < 40; ++i) y.push_back(std::min(0.1 * i, 2.55));
  EXPECT_EQ(limit_of(y).from, 26U);
  EXPECT_EQ(limit_of(y).to, 40U);
  for (int i = 0; i < 5; ++i) y.push_back(2.0 - 0.1 * i);  // and falls again
  EXPECT_EQ(limit_of(y).to, 40U);
  // The steps of a converter grow as a curve comes to rest, and are no limit.
  std::vector<double> steps;
  for (int i = 0; i < 100; ++i) steps.push_back(std::round(20.0 * (1.0 - std::exp(-i / 20.0))));
  EXPECT_EQ(limit_of(steps).from, steps.size());
}

TEST(LoadingPart, BranchesTurnWhereTheStrainDoes) {
  std::vector<double> x;
  for (int i = 0; i < 400; ++i) x.push_back(std::abs(std::fmod(i / 100.0, 2.0) - 1.0));  // down, up
  const std::vector<Branch> branches = branches_of(x);
  ASSERT_EQ(branches.size(), 4U);
  EXPECT_FALSE(branches[0].up);
  EXPECT_EQ(branches[1].from, 100U);
  EXPECT_EQ(branches[1].to, 201U);
}

// In many rows noise alone falls by ten deviations, before the load rises at all.
TEST(LoadingPart, NoiseOfManyRowsIsNoFall) {
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<double> y;
  for (int i = 0; i < 400'000; ++i)
    y.push_back(noise(random) + std::max(0.0, 0.4 * (i - 200'000) / 2e5));
  EXPECT_EQ(rows_before_fall(y, 0.1), y.size());
  for (int i = 0; i < 10; ++i) y.push_back(0.2);
  EXPECT_NEAR(static_cast<double>(rows_before_fall(y, 0.1)), 4e5, 2e4);
}

TEST(LoadingPart, SeveralLoadingsAskForOne) {
  Rows rows;
  for (int cycle = 1; cycle <= 3; ++cycle)
    for (int i = 0; i < 100; ++i) {
      const double strain = 0.002 * (i < 50 ? i : 100 - i);
      rows.x.push_back(strain);
      rows.y.push_back(1e3 * cycle * strain);
    }
  EXPECT_TRUE(test::refusal([&] {
                return fit_uniaxial(rows.x, rows.y, {});
              }).starts_with("the curve has 3 loadings, up to strains of 0.1, 0.1, 0.1"));
  EXPECT_EQ(test::refusal([&] { return fit_uniaxial(rows.x, rows.y, {.cycle = 4}); }),
            "the curve has 3 loadings, and `--cycle 4` is not among them; give one of 1 to 3");
  const Fit second = fit_uniaxial(rows.x, rows.y, {.cycle = 2});
  EXPECT_NEAR(second.parameters[0].estimate, 2.0, 1e-9);  // kPa, exact data
}

// Treloar's simple tension of rubber (1944), as Steinmann, Hossain and Possart print it (Arch.
// Appl. Mech. 82, 2012), and what scipy 1.10 fits to it: tests/bench/fit_scipy.py.
TEST(LoadingPart, TreloarsRubberAsScipyFitsIt) {
  const Rows rubber{{0.0,  0.01, 0.12, 0.24, 0.39, 0.61, 0.89, 1.17, 1.42, 2.01, 2.58, 3.03, 3.76,
                     4.36, 4.76, 5.16, 5.4,  5.62, 5.87, 6.05, 6.16, 6.27, 6.43, 6.5,  6.61},
                    {0.0,    30e3,   140e3,  230e3,  320e3,  410e3,  500e3,  580e3,  670e3,
                     850e3,  1040e3, 1210e3, 1580e3, 1940e3, 2290e3, 2670e3, 3020e3, 3390e3,
                     3750e3, 4120e3, 4470e3, 4850e3, 5210e3, 5570e3, 6300e3}};
  const auto fitted = [&](UniaxialTest::Model model) {
    return fit_uniaxial(rubber.x, rubber.y,
                        {.model = model, .loading = UniaxialTest::Loading::tension});
  };
  const Fit yeoh = fitted(UniaxialTest::Model::yeoh);
  EXPECT_NEAR(yeoh.parameters[0].estimate, 1053.21, 0.01);  // the digits that scipy prints
  EXPECT_NEAR(yeoh.parameters[0].std_error, 69.7, 0.1);
  EXPECT_NEAR(yeoh.parameters[1].estimate, -1.87853, 1e-5);
  EXPECT_NEAR(yeoh.parameters[2].estimate, 0.0463224, 1e-7);
  // There is a second minimum at 3.917, of half a percent more squares.
  const Fit ogden = fitted(UniaxialTest::Model::ogden);
  EXPECT_NEAR(ogden.parameters[0].estimate, 177.060, 0.001);
  EXPECT_NEAR(ogden.parameters[1].estimate, -7.81743, 1e-5);
  // The last row has a term of its own, whose mu is 1e-79 kPa. scipy's end from all starts of the
  // grid: E and the two other exponents agree to the shallowness of that term.
  const Fit three = fitted(UniaxialTest::Model::ogden3);
  ASSERT_EQ(three.termination, Termination::converged);
  EXPECT_NEAR(three.parameters[0].estimate, 1552.43, 0.03);
  std::array alpha{three.parameters[4].estimate, three.parameters[5].estimate,
                   three.parameters[6].estimate};
  std::sort(alpha.begin(), alpha.end());
  EXPECT_NEAR(alpha[0], -16.152, 0.001);
  EXPECT_NEAR(alpha[1], -4.3004, 0.0002);
  EXPECT_NEAR(alpha[2], 93.48, 0.05);
}

// Yeoh 1993 and Ogden 1972 by their own formulas, in tension and compression at once.
TEST(LoadingPart, TensionAndCompressionAreOneLaw) {
  Rows yeoh, ogden;
  for (int i = -40; i <= 40; ++i) {
    const double strain = 0.01 * i;
    const double l = 1.0 + strain;
    const double over = l * l + 2.0 / l - 3.0;
    yeoh.x.push_back(strain);
    yeoh.y.push_back(2.0 * (l - 1.0 / (l * l)) *
                     (500.0 + 2.0 * 80.0 * over + 3.0 * 20.0 * over * over));
  }
  // Over stretches from 1 to 7.
  for (int i = 0; i <= 120; ++i) {
    const double l = 1.0 + 0.05 * i;
    ogden.x.push_back(l - 1.0);
    double sum = 0.0;
    for (const auto& [mu, alpha] :
         {std::pair{630.0, 1.3}, {1.2, 5.0}, {-10.0, -2.0}})  // Ogden 1972
      sum += mu * (std::pow(l, alpha - 1.0) - std::pow(l, -0.5 * alpha - 1.0));
    ogden.y.push_back(sum);
  }
  const Fit one = fit_uniaxial(yeoh.x, yeoh.y, {.model = UniaxialTest::Model::yeoh});
  EXPECT_NEAR(one.parameters[0].estimate, 3.0, 1e-9);   // 6 C1, kPa, exact data
  EXPECT_NEAR(one.parameters[1].estimate, 0.08, 1e-9);  // likewise
  EXPECT_NEAR(one.parameters[2].estimate, 0.02, 1e-9);  // likewise
  const Fit three = fit_uniaxial(
      ogden.x, ogden.y,
      {.model = UniaxialTest::Model::ogden3, .loading = UniaxialTest::Loading::tension});
  ASSERT_EQ(three.termination, Termination::converged);
  // Exact data: rounding, times the condition of six numbers that are told apart by little (4e7).
  const std::array truth{1.2675, 0.63, 0.0012, -0.01, 1.3, 5.0, -2.0};
  ASSERT_EQ(three.parameters.size(), truth.size());
  EXPECT_NEAR(three.parameters[0].estimate, truth[0], 1e-7 * truth[0]);
  std::vector<std::pair<double, double>> terms;  // alpha, mu, in any order
  for (std::size_t k = 1; k <= 3; ++k)
    terms.emplace_back(three.parameters[3 + k].estimate, three.parameters[k].estimate);
  std::sort(terms.begin(), terms.end());
  EXPECT_NEAR(terms[0].first, -2.0, 1e-5);
  EXPECT_NEAR(terms[1].first, 1.3, 1e-5);
  EXPECT_NEAR(terms[2].first, 5.0, 1e-5);
  EXPECT_NEAR(terms[1].second, 0.63, 1e-5);
}

// Laws drawn at random: each is met to rounding, whatever its exponents.
TEST(LoadingPart, OgdensTermsAreFoundWhereverTheyAre) {
  std::mt19937 engine(2024);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  };
  for (int k = 0; k < 10; ++k) {
    const std::array<std::pair<double, double>, 3> terms{
        std::pair{-draw(1.0, 20.0), draw(-6.0, -1.0)},
        {draw(100.0, 800.0), draw(1.0, 3.0)},
        {draw(0.1, 3.0), draw(4.0, 9.0)}};
    double modulus = 0.0;
    for (const auto& [mu, alpha] : terms) modulus += 1.5e-3 * mu * alpha;
    Rows rows;
    for (int i = 0; i <= 120; ++i) {
      const double l = 1.0 + 0.05 * i;
      rows.x.push_back(l - 1.0);
      rows.y.push_back(0.0);
      for (const auto& [mu, alpha] : terms)
        rows.y.back() += mu * (std::pow(l, alpha - 1.0) - std::pow(l, -0.5 * alpha - 1.0));
    }
    const Fit fit = fit_uniaxial(
        rows.x, rows.y,
        {.model = UniaxialTest::Model::ogden3, .loading = UniaxialTest::Loading::tension});
    EXPECT_NEAR(fit.parameters[0].estimate, modulus, 1e-6 * modulus) << k;
  }
}

TEST(LoadingPart, AToeIsNamedAndTakenOffOnRequest) {
  Rows rows;
  for (int i = 0; i <= 100; ++i) {
    rows.x.push_back(0.002 * i);
    rows.y.push_back(2e4 * std::max(0.0, 0.002 * i - 0.04));
  }
  const Fit named = fit_uniaxial(rows.x, rows.y, {.loading = UniaxialTest::Loading::compression});
  ASSERT_FALSE(named.warnings.empty());
  EXPECT_NE(named.warnings[0].find("the curve has a toe up to a strain of 0.0396"),
            std::string::npos)
      << named.warnings[0];
  // What is announced is what `--toe` does.
  const Fit off =
      fit_uniaxial(rows.x, rows.y, {.loading = UniaxialTest::Loading::compression, .toe = true});
  const double change = off.parameters[0].estimate / named.parameters[0].estimate - 1.0;
  EXPECT_TRUE(named.warnings[0].ends_with(" by " + percent_text(change))) << named.warnings[0];
  EXPECT_EQ(fit_uniaxial(rows.x, rows.y, {.toe = true}).parameters[0].estimate,
            off.parameters[0].estimate);
  EXPECT_NEAR(off.parameters[0].estimate, 20.0, 0.02);  // the knee is found on a grid
}

// A creep with a jump on a row: that row is the first of the response, and single rows of a noisy
// level do not begin it.
TEST(StepOrigin, OfAJumpIsTheFirstRowAfterIt) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.04);
  std::vector<double> time, strain;
  for (int i = 0; i < 300; ++i) {
    time.push_back(0.2 * i);
    strain.push_back(noise(random) +
                     (i < 50 ? 0.0 : 8.0 + 9.0 * (1.0 - std::exp((50 - i) / 40.0))));
  }
  strain[20] = 1.0;
  const StepOrigin found = step_origin(time, strain, AfterStep::rises, 0.0);
  EXPECT_EQ(found.best.time, time[50]);
  EXPECT_EQ(found.best.first, time[50]);
}

TEST(LoadingPart, TheFirstOfSeveralPresses) {
  std::vector<double> depth, force;
  const auto add = [&](double from, double to) {
    for (int i = 0; i < 50; ++i) depth.push_back(from + (to - from) * i / 50.0);
  };
  add(0.0, 0.5);  // a short press before
  add(0.5, 0.1);
  add(0.1, 1.0);
  add(1.0, 0.0);
  add(0.0, 1.0);
  EXPECT_EQ(one_way(depth, Way::approach).to, 151U);
  EXPECT_EQ(one_way(depth, Way::approach).loadings, 2U);
  EXPECT_EQ(one_way(depth, Way::retract).from, 150U);
  EXPECT_EQ(one_way(depth, Way::retract).to, 201U);
  EXPECT_EQ(one_way(depth, Way::all).to, depth.size());
}

TEST(LoadingPart, ABreakEndsAPress) {
  std::vector<double> force;
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) force.push_back(std::pow(i / 200.0, 1.5) + 0.05 * normal(engine));
  EXPECT_EQ(rows_before_break(force), 200U);  // noise is no break
  for (int i = 150; i < 200; ++i) force[as_index(i)] *= 0.4;
  const std::size_t whole = rows_before_break(force);
  EXPECT_GT(whole, 140U);
  EXPECT_LE(whole, 150U);
  for (double& each : force) each = -each;  // another sign is no break
  EXPECT_EQ(rows_before_break(force), 200U);
  // Nor is one row that stands out of noise as large: those beyond are 0.3 lower on average.
  std::vector<double> noisy;
  for (int i = 0; i < 200; ++i) noisy.push_back(i / 200.0 + (i % 2 == 0 ? 0.15 : -0.15));
  noisy[190] += 0.2;
  EXPECT_EQ(rows_before_break(noisy), 200U);
}

// Tests like those of laboratories: stiffening or not, with noise, slack before, and a rupture that
// is sudden, in steps, or drawn out, after which the grips go on.
TEST(LoadingPart, TwentyFiveTestsToRupture) {
  std::mt19937 engine(41);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 25; ++k) {
    const double young = 20e3 * std::pow(20.0, any(engine));  // Pa, 20 to 400 kPa
    const double stiffening = k % 2 == 0 ? 0.0 : 2.0 * any(engine);
    const double failure = 0.2 + 0.4 * any(engine);
    const double noise = 0.004 * any(engine);
    const int rows = 150 + 40 * k;
    Rows test;
    for (int i = 0; i <= rows; ++i) {
      const double strain = 1.6 * failure * i / rows;
      const auto law = [&](double e) { return young * e * (1.0 + stiffening * e); };
      double stress = law(strain);
      const double beyond = strain / failure - 1.0;
      if (beyond > 0.0 && k % 3 == 0) stress = 0.02 * law(failure);  // sudden
      if (beyond > 0.0 && k % 3 == 1)                                // in steps
        stress = law(failure) * std::max(0.05, 0.7 - 0.25 * std::floor(10.0 * beyond));
      if (beyond > 0.0 && k % 3 == 2) stress = law(failure) * std::exp(-8.0 * beyond);  // drawn out
      test.x.push_back(strain);
      test.y.push_back(stress + noise * law(failure) * normal(engine));
    }
    const Fit fit = fit_uniaxial(test.x, test.y, {.to = 0.1 * failure});
    // The chord of E e (1 + s e) up to a tenth of the failure, and five errors of the slope.
    const double mean = 1.0 + stiffening * 0.1 * failure;
    EXPECT_NEAR(fit.parameters[0].estimate / (young / 1e3), mean,
                5.0 * fit.parameters[0].std_error / (young / 1e3) + 1e-3)
        << k;
    const Fit whole = fit_uniaxial(test.x, test.y, {});
    EXPECT_NEAR(whole.range_high, failure, 0.03 * failure) << k;  // the rupture is found
  }
}

}  // namespace
}  // namespace palpate::fit
