// The judgement of a live run on synthetic curves with noise: what agrees, and what explains the
// rest.
#include "live/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace palpate::live {
namespace {

constexpr double deepest = 2e-3;    // m
constexpr double tolerance = 0.05;  // the default of a scenario
constexpr double noise = 1e-3;      // N

// Pressed in 1 s, held for 1 s and withdrawn in 1 s, with a reading every 20 ms: the travel, m.
std::vector<double> travels() {
  std::vector<double> travel;
  for (int i = 0; i <= 150; ++i) {
    const double time = 0.02 * i;
    travel.push_back(deepest * std::min({time, 1.0, 3.0 - time}));
  }
  return travel;
}

// N: a sphere of 5 mm on a standard linear solid whose surface is at `surface` (m, in travel). The
// force of the part that relaxes decays by exp(-0.02 s / `relaxation`) from row to row.
std::vector<double> force_of(const std::vector<double>& travel, double surface,
                             double relaxation = 0.5) {
  const double elastic = 4.0 / 3.0 * std::sqrt(5e-3) * 12e3 / 0.7975;  // N/m^1.5
  std::vector<double> force;
  double before = 0.0;
  double memory = 0.0;
  for (const double each : travel) {
    const double root = std::pow(std::max(0.0, each - surface), 1.5);
    memory = memory * std::exp(-0.02 / relaxation) + (root - before);
    before = root;
    force.push_back(root > 0.0 ? std::max(0.0, elastic * (root + 1.5 * memory)) : 0.0);
  }
  return force;
}

// A run of that specimen, as the gauge shows it, with another specimen for the model's.
MeasuredCurve run_with(double surface, const std::function<double(double)>& shown, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> scatter(0.0, noise);
  MeasuredCurve curve;
  curve.travel = travels();
  curve.model = force_of(curve.travel, 0.0);
  for (const double force : force_of(curve.travel, surface))
    curve.measured.push_back(shown(force) + scatter(generator));
  for (int i = 0; i < 40; ++i) curve.free.push_back(shown(0.0) + scatter(generator));
  return curve;
}

double as_it_is(double force) { return force; }

TEST(Verdict, OfTheModelsOwnSpecimenIsAgreement) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const Verdict verdict = judge(run_with(0.0, as_it_is, seed), tolerance);
    ASSERT_EQ(verdict.outcome, Verdict::Outcome::agrees) << seed << verdict_sentence(verdict);
    EXPECT_TRUE(verdict.causes.empty());
    // Five standard errors of 151 rows, of 40 readings, and of the few rows after the contact.
    EXPECT_NEAR(verdict.difference, noise, 5.0 * noise / std::sqrt(2.0 * 151.0)) << seed;
    EXPECT_NEAR(verdict.offset, 0.0, 5.0 * 1.25 * noise / std::sqrt(40.0)) << seed;
    EXPECT_NEAR(verdict.drift, 0.0, 5.0 * noise) << seed;
    EXPECT_NEAR(verdict.noise, noise, 0.8 * noise) << seed;
    EXPECT_NEAR(verdict.stiffness, 1.0, 0.01) << seed;
    EXPECT_NEAR(verdict.contact, verdict.contact_model, 0.05e-3) << seed;
    EXPECT_NEAR(verdict.release, verdict.release_model, 0.05e-3) << seed;
    EXPECT_NEAR(verdict.hysteresis, verdict.hysteresis_model, 0.03) << seed;
  }
}

// What is wrong with the measurement, and whether the causes say just that.
struct Wrong {
  const char* name;
  double surface;
  double (*shown)(double force);
  std::vector<Cause> causes;
};

class WrongRun : public testing::TestWithParam<Wrong> {};

TEST_P(WrongRun, IsFoundAndNamed) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const MeasuredCurve curve = run_with(GetParam().surface, GetParam().shown, seed);
    const Verdict verdict = judge(curve, tolerance);
    EXPECT_EQ(verdict.outcome, Verdict::Outcome::differs) << seed;
    EXPECT_EQ(verdict.causes, GetParam().causes) << seed << " " << verdict_sentence(verdict);
    EXPECT_TRUE(verdict.explained) << seed;
    // A specimen that is touched before the first row has relaxed there.
    if (GetParam().surface >= 0.0) {
      EXPECT_TRUE(verdict.sure) << seed << " " << verdict_sentence(verdict);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Verdicts, WrongRun,
    testing::Values(
        Wrong{"NoSpecimen", 1.0, as_it_is, {Cause::no_specimen}},
        Wrong{"TurnedSign", 0.0, [](double force) { return -force; }, {Cause::wrong_sign}},
        Wrong{"Tare", 0.0, [](double force) { return force + 0.1; }, {Cause::wrong_tare}},
        Wrong{"NegativeTare", 0.0, [](double force) { return force - 0.1; }, {Cause::wrong_tare}},
        Wrong{"LowerSurface", 0.4e-3, as_it_is, {Cause::wrong_surface}},
        Wrong{"HigherSurface", -0.4e-3, as_it_is, {Cause::wrong_surface}},
        Wrong{"SofterSpecimen",
              0.0,
              [](double force) { return 0.6 * force; },
              {Cause::wrong_stiffness}},
        Wrong{"StifferSpecimen",
              0.0,
              [](double force) { return 1.5 * force; },
              {Cause::wrong_stiffness}},
        Wrong{"OuncesForGrams",
              0.0,
              [](double force) { return 28.35 * (force + 3e-3 * std::sin(100.0 * force)); },
              {Cause::wrong_stiffness}},
        Wrong{"TurnedSignAndTare",
              0.0,
              [](double force) { return 0.1 - force; },
              {Cause::wrong_sign, Cause::wrong_tare}},
        Wrong{"TareWithoutSpecimen",
              1.0,
              [](double force) { return force + 0.1; },
              {Cause::wrong_tare, Cause::no_specimen}}),
    [](const auto& wrong) { return wrong.param.name; });

// What a tare leaves within what is allowed, a little friction or drift, is no second fault and no
// other one; noise makes it no less sure.
TEST(Verdict, ATareIsTheOnlyFaultBesideSmallOnes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto tared = [&](const std::function<double(std::size_t)>& more) {
      MeasuredCurve curve = run_with(
          0.0, [](double force) { return force + 0.2; }, seed);
      for (std::size_t i = 0; i < curve.measured.size(); ++i) curve.measured[i] += more(i);
      for (double& reading : curve.free) reading += more(0);
      return judge(curve, tolerance);
    };
    std::mt19937 generator(seed);
    std::normal_distribution<double> scatter(0.0, 20e-3);
    for (const Verdict& verdict :
         {tared([](std::size_t i) { return i <= 100 ? 4e-3 : -4e-3; }),
          tared([](std::size_t i) { return 6e-3 * static_cast<double>(i) / 150.0; }),
          tared([&](std::size_t) { return scatter(generator); })}) {
      EXPECT_EQ(verdict.causes, std::vector{Cause::wrong_tare}) << verdict_sentence(verdict);
      EXPECT_TRUE(verdict.sure) << verdict_sentence(verdict);
    }
  }
}

TEST(Verdict, MeasuresHowFarTheSurfaceIsOff) {
  for (const double surface : {-0.4e-3, -0.2e-3, 0.2e-3, 0.4e-3, 0.8e-3}) {
    const Verdict verdict = judge(run_with(surface, as_it_is, 7), tolerance);
    EXPECT_NEAR(verdict.surface, surface, 0.03e-3);
  }
}

// What moves or falls out by itself is named as that, not as another surface.
TEST(Verdict, NamesADriftAndAnOutlier) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    MeasuredCurve drifting = run_with(0.0, as_it_is, seed);
    const auto last = static_cast<double>(drifting.measured.size() - 1);
    for (std::size_t i = 0; i < drifting.measured.size(); ++i)
      drifting.measured[i] += 0.1 * static_cast<double>(i) / last;
    const Verdict drift = judge(drifting, tolerance);
    EXPECT_EQ(drift.causes, std::vector<Cause>{Cause::drift}) << seed << verdict_sentence(drift);

    MeasuredCurve spiked = run_with(0.0, as_it_is, seed);
    spiked.measured[70] += 3.0;
    const Verdict spike = judge(spiked, tolerance);
    EXPECT_EQ(spike.outcome, Verdict::Outcome::differs);
    EXPECT_EQ(spike.causes, std::vector<Cause>{Cause::outliers}) << verdict_sentence(spike);
    EXPECT_EQ(spike.outliers, 1U);
  }
}

// The press has 0.3 N. A drift beyond it turns the correlation with the model, and so does a zero
// that jumps, as where a gauge restarts.
TEST(Verdict, ADriftOrAJumpIsNoTurnedSign) {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const double change : {-2.0, -1.0, -0.5, -0.3, 0.5, 2.0}) {
      MeasuredCurve drifting = run_with(0.0, as_it_is, seed);
      MeasuredCurve jumped = drifting;
      const auto last = static_cast<double>(drifting.measured.size() - 1);
      for (std::size_t i = 0; i < drifting.measured.size(); ++i) {
        drifting.measured[i] += change * static_cast<double>(i) / last;
        if (i > 40) jumped.measured[i] += change;
      }
      const Verdict drift = judge(drifting, tolerance);
      EXPECT_EQ(drift.causes, std::vector<Cause>{Cause::drift}) << verdict_sentence(drift);
      EXPECT_NEAR(drift.drift, change, 0.02) << verdict_sentence(drift);
      const Verdict jump = judge(jumped, tolerance);
      EXPECT_FALSE(jump.has(Cause::wrong_sign)) << change << verdict_sentence(jump);
    }
}

// The largest of a hundred readings is three standard deviations of the noise from zero, more than
// the two that a difference is allowed.
TEST(Verdict, NamesAMissingSpecimenInNoise) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    MeasuredCurve empty = run_with(1.0, as_it_is, seed);
    std::mt19937 generator(seed);
    std::normal_distribution<double> scatter(0.0, 30.0 * noise);
    for (std::vector<double>* readings : {&empty.measured, &empty.free})
      for (double& reading : *readings) reading += scatter(generator);
    const Verdict verdict = judge(empty, tolerance);
    EXPECT_EQ(verdict.causes, std::vector{Cause::no_specimen}) << verdict_sentence(verdict);
  }
}

// However far it is: it turns the correlation with the model, and is no turned sign.
TEST(Verdict, AFarReadingIsNoTurnedSign) {
  MeasuredCurve curve = run_with(0.0, as_it_is, 1);
  curve.measured[50] -= 20.0;
  const Verdict verdict = judge(curve, tolerance);
  EXPECT_LT(verdict.stiffness, -0.1);
  EXPECT_EQ(verdict.causes, std::vector{Cause::outliers}) << verdict_sentence(verdict);
}

// An offset of the gauge that is no fault by itself must not make another cause of one.
TEST(Verdict, NamesTheSurfaceBesideASmallOffset) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto shown = [](double force) { return force + 9e-3; };
    for (const double surface : {0.25e-3, 0.5e-3}) {
      const Verdict verdict = judge(run_with(surface, shown, seed), tolerance);
      EXPECT_EQ(verdict.causes, std::vector{Cause::wrong_surface}) << verdict_sentence(verdict);
      EXPECT_NEAR(verdict.surface, surface, 0.03e-3);
    }
  }
}

// A finger that stood where no step asked for it was waited for, which says nothing.
TEST(Verdict, LeavesOutWhatWasWaitedFor) {
  record::CaseRecord record;
  for (const double time : {0.0, 1.0, 2.0, 3.0}) {
    record.contact.push_back({});
    record.contact.back().time = time;
    record.measured.push_back({});
  }
  EXPECT_EQ(measured_curve(record, {}, {}, 1.5).time, (std::vector{0.0, 1.0}));
}

// Each fault alone is named, and none of them is called a surface.
TEST(Verdict, NamesWhatIsWrongWithGaugeAndStand) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto faulty = [&](const std::function<double(std::size_t, double)>& shown) {
      MeasuredCurve curve = run_with(0.0, as_it_is, seed);
      for (std::size_t i = 0; i < curve.measured.size(); ++i)
        curve.measured[i] = shown(i, curve.measured[i]);
      return judge(curve, tolerance);
    };
    const std::vector<double> truth = run_with(0.0, as_it_is, seed).measured;
    const Verdict friction =
        faulty([](std::size_t i, double force) { return force + (i <= 100 ? 0.04 : -0.04); });
    EXPECT_EQ(friction.causes, std::vector{Cause::friction}) << verdict_sentence(friction);
    EXPECT_NEAR(friction.friction, 0.04, noise) << seed;
    const Verdict lag =
        faulty([&](std::size_t i, double) { return truth[i - std::min<std::size_t>(i, 7)]; });
    EXPECT_EQ(lag.causes, std::vector{Cause::lag}) << verdict_sentence(lag);
    EXPECT_NEAR(lag.lag, 7.0, 1.0) << "rows, without times";
    const Verdict lost = faulty([](std::size_t i, double force) { return i < 70 ? force : 0.0; });
    EXPECT_EQ(lost.causes, std::vector{Cause::lost_force}) << verdict_sentence(lost);
    EXPECT_NEAR(lost.lost_at, 70.0, 1.0);
    const Verdict full = faulty([](std::size_t, double force) { return std::min(force, 0.12); });
    EXPECT_EQ(full.causes, std::vector{Cause::overload}) << verdict_sentence(full);
    EXPECT_NEAR(full.ceiling, 0.12, 1e-12);
  }
}

// What an agreement cannot say is said with it.
TEST(Verdict, AgreesWithAWarningOnNoiseAndOutliers) {
  MeasuredCurve curve = run_with(0.0, as_it_is, 1);
  curve.measured[70] += 0.1;
  const Verdict spiked = judge(curve, tolerance);
  EXPECT_EQ(spiked.outcome, Verdict::Outcome::agrees) << verdict_sentence(spiked);
  EXPECT_EQ(spiked.causes, std::vector{Cause::outliers});
  std::mt19937 generator(1);
  std::normal_distribution<double> scatter(0.0, 20e-3);
  MeasuredCurve noisy = run_with(0.0, as_it_is, 1);
  for (double& force : noisy.measured) force += scatter(generator);
  const Verdict blurred = judge(noisy, tolerance);
  EXPECT_EQ(blurred.outcome, Verdict::Outcome::agrees) << verdict_sentence(blurred);
  EXPECT_EQ(blurred.causes, std::vector{Cause::noise});
}

TEST(Verdict, NeverAgreesWithAPressThatStopsShort) {
  MeasuredCurve curve = run_with(0.0, as_it_is, 1);
  curve.asked = 1.5 * deepest;
  const Verdict verdict = judge(curve, tolerance);
  EXPECT_EQ(verdict.outcome, Verdict::Outcome::differs);
  EXPECT_EQ(verdict.causes, std::vector{Cause::short_press});
  EXPECT_NE(verdict_sentence(verdict).find("it ends at 2 mm of 3 mm"), std::string::npos);
}

// Without readings of their own the rows before contact say what the noise is.
TEST(Verdict, TakesTheNoiseFromAllRowsBeforeContact) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    MeasuredCurve curve = run_with(0.0, as_it_is, seed);
    curve.free.clear();
    std::mt19937 generator(seed);
    std::normal_distribution<double> scatter(0.0, 20e-3);
    for (double& force : curve.measured) force += scatter(generator);
    for (int i = 0; i < 40; ++i) {
      curve.travel.insert(curve.travel.begin(), -1e-4 * i);
      curve.model.insert(curve.model.begin(), 0.0);
      curve.measured.insert(curve.measured.begin(), scatter(generator));
    }
    const Verdict verdict = judge(curve, tolerance);
    EXPECT_EQ(verdict.outcome, Verdict::Outcome::agrees) << seed << verdict_sentence(verdict);
    EXPECT_NEAR(verdict.noise, 20e-3, 0.8 * 20e-3) << seed;
  }
}

TEST(Verdict, ALevelForceEndsNowhere) {
  MeasuredCurve curve = run_with(0.0, as_it_is, 1);
  for (std::size_t i = 101; i < curve.measured.size(); ++i)
    curve.measured[i] = i == 130 ? 0.2 : 0.05 - 1e-9 * static_cast<double>(i);
  const std::string said = verdict_sentence(judge(curve, tolerance));
  EXPECT_NE(said.find("release at unknown (model "), std::string::npos) << said;
}

// Another law is none of the causes, and is not made one.
TEST(Verdict, SaysThatNothingExplainsAnotherLaw) {
  const Verdict verdict = judge(run_with(
                                    0.0, [](double force) { return 5.0 * force * force; }, 3),
                                tolerance);
  EXPECT_EQ(verdict.outcome, Verdict::Outcome::differs);
  EXPECT_FALSE(verdict.explained);
  EXPECT_NE(verdict_sentence(verdict).find("no single fault of gauge, stand or specimen"),
            std::string::npos);
  const Verdict tared = judge(run_with(
                                  0.0, [](double force) { return 5.0 * force * force + 0.1; }, 3),
                              tolerance);
  EXPECT_EQ(tared.causes, std::vector{Cause::wrong_tare}) << "is true by itself";
  EXPECT_FALSE(tared.explained);
}

// A softer tissue that relaxes in 2 s looks like a late gauge, and friction with drift like a
// higher surface: what one cause leaves of them says that it may be another.
TEST(Verdict, IsNotSureOfACauseThatLeavesMuch) {
  const auto expect_not_sure = [](const Verdict& verdict) {
    EXPECT_EQ(verdict.outcome, Verdict::Outcome::differs);
    EXPECT_FALSE(verdict.sure) << verdict_sentence(verdict);
    EXPECT_NE(verdict_sentence(verdict).find(verdict.explained
                                                 ? "it cannot be told from another relaxation"
                                                 : "no single fault of gauge, stand or specimen"),
              std::string::npos)
        << verdict_sentence(verdict);
    EXPECT_TRUE(std::get<std::string>(verdict_findings(verdict)[1].value)
                    .ends_with(verdict.explained ? " unsure" : "unexplained"));
  };
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const MeasuredCurve good = run_with(0.0, as_it_is, seed);
    MeasuredCurve slow = good;
    const std::vector<double> softer = force_of(slow.travel, 0.0, 2.0);
    for (std::size_t i = 0; i < softer.size(); ++i)
      slow.measured[i] += 0.7 * softer[i] - slow.model[i];
    const Verdict relaxing = judge(slow, tolerance);
    EXPECT_EQ(relaxing.causes, std::vector{Cause::lag}) << verdict_sentence(relaxing);
    expect_not_sure(relaxing);
    // mN of friction, and of drift until the end.
    for (const auto& [friction, drift] : {std::pair{40.0, 30.0}, {40.0, 60.0}, {60.0, 60.0}}) {
      MeasuredCurve both = good;
      for (std::size_t i = 0; i < both.measured.size(); ++i)
        both.measured[i] +=
            1e-3 * ((i <= 100 ? friction : -friction) + drift * static_cast<double>(i) / 150.0);
      for (double& reading : both.free) reading += 1e-3 * friction;
      const Verdict verdict = judge(both, tolerance);
      EXPECT_FALSE(verdict.has(Cause::wrong_surface)) << verdict_sentence(verdict);
      expect_not_sure(verdict);
    }
  }
}

TEST(Verdict, IsAsStrictAsItsTolerance) {
  const MeasuredCurve curve = run_with(
      0.0, [](double force) { return 1.08 * force; }, 5);
  EXPECT_EQ(judge(curve, 0.02).outcome, Verdict::Outcome::differs);
  EXPECT_EQ(judge(curve, 0.10).outcome, Verdict::Outcome::agrees);
  // A gauge cannot agree better than it scatters.
  EXPECT_EQ(judge(run_with(0.0, as_it_is, 5), 1e-6).outcome, Verdict::Outcome::agrees);
}

TEST(Verdict, CountsWhatTheGaugeDrifts) {
  MeasuredCurve curve = run_with(0.0, as_it_is, 5);
  for (std::size_t i = 0; i < curve.measured.size(); ++i)
    curve.measured[i] += 20e-3 * static_cast<double>(i) / 150.0;
  EXPECT_NEAR(judge(curve, tolerance).drift, 20e-3, 3.0 * noise);
}

// Out of what there is: rows before contact in place of free readings, or nothing at all.
TEST(Verdict, TakesWhatTheColumnsHave) {
  MeasuredCurve curve = run_with(
      0.0, [](double force) { return force + 0.1; }, 5);
  curve.free.clear();
  EXPECT_NEAR(judge(curve, tolerance).offset, 0.1, 5.0 * noise);
  EXPECT_EQ(judge(curve, tolerance).causes, std::vector{Cause::wrong_tare});

  curve.measured.assign(curve.measured.size(), Verdict::unknown);
  EXPECT_EQ(judge(curve, tolerance).outcome, Verdict::Outcome::not_judged);
  EXPECT_EQ(judge({}, tolerance).outcome, Verdict::Outcome::not_judged);

  MeasuredCurve unpressed = run_with(0.0, as_it_is, 5);
  unpressed.model.assign(unpressed.model.size(), 0.0);
  EXPECT_EQ(judge(unpressed, tolerance).outcome, Verdict::Outcome::not_judged);

  // A press without a way back has no hysteresis, and one row no contact point.
  MeasuredCurve press = run_with(0.0, as_it_is, 5);
  for (auto* column : {&press.travel, &press.model, &press.measured}) column->resize(51);
  EXPECT_TRUE(std::isnan(judge(press, tolerance).hysteresis));
  EXPECT_EQ(judge(press, tolerance).outcome, Verdict::Outcome::agrees);
  for (auto* column : {&press.travel, &press.model, &press.measured})
    column->erase(column->begin(), column->end() - 1);
  EXPECT_TRUE(std::isnan(judge(press, tolerance).contact));
}

TEST(Verdict, IsOneLineAndItsFindingsAreNumbers) {
  const Verdict verdict = judge(run_with(
                                    0.0, [](double force) { return force + 0.1; }, 5),
                                tolerance);
  const std::string line = verdict_sentence(verdict);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_NE(line.find("measured and model differ: "), std::string::npos) << line;
  EXPECT_NE(line.find("wrong tare: the gauge shows 0.1 N"), std::string::npos) << line;
  for (const record::Finding& finding : verdict_findings(verdict))
    if (const double* value = std::get_if<double>(&finding.value)) {
      EXPECT_TRUE(std::isfinite(*value)) << finding.name;
    }
  EXPECT_EQ(verdict_findings(verdict).front().value, record::Cell(std::string("differs")));
  EXPECT_TRUE(verdict_findings({}).empty());
}

}  // namespace
}  // namespace palpate::live
