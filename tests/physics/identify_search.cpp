// What a measured curve tells, what it cannot, and when it is told so.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "base/doing.h"
#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "identify/box_search.h"
#include "identify/unknowns.h"
#include "identify_scenes.h"
#include "record/csv.h"
#include "refusal.h"

namespace palpate {
namespace {

using test::IdentifyScene;

IdentifyScene with_unknowns(const char* name, const std::vector<std::string>& unknowns) {
  IdentifyScene scene = test::identify_scene(name);
  scene.unknowns = unknowns;
  return scene;
}

std::string refusal(const IdentifyScene& scene, const identify::Measurement& curve) {
  return test::refusal([&] { return test::identified(scene, curve); });
}

bool warns_of_the_model(const identify::Identification& found) {
  return std::any_of(found.warnings.begin(), found.warnings.end(), [](const std::string& text) {
    return text.starts_with("neighbouring residuals are correlated");
  });
}

// The line of progress goes on within its parts.
TEST(Identify, CountsTheCurvesThatItTook) {
  const IdentifyScene& scene = test::identify_scene("layer");
  const auto curve = test::noisy(test::clean_curve(scene), 0.01, 1);
  (void)test::identified(scene, curve);
  const Doing last = doing();  // the starts of the contact, the last part of three
  EXPECT_EQ(last.all, 100U);
  EXPECT_GT(last.done, 67U) << "the part begins with 66";
  EXPECT_NE(last.text.find(" curves"), std::string::npos) << last.text;
}

// A half-space under a layer's curve: the base's stiffness is taken for the tissue's own.
TEST(Identify, HertzOnALayerIsBiasedAndTheLayerCuresIt) {
  const IdentifyScene& scene = test::identify_scene("layer");
  const auto curve = test::noisy(test::clean_curve(scene), 0.01, 1);
  const auto wrong = test::identified(scene, curve, {.model_error = false}, {"solver.model=hertz"});
  // The model states its error, and with it the interval contains the truth.
  const auto honest = test::identified(scene, curve, {}, {"solver.model=hertz"});
  EXPECT_LT(*honest.unknowns[0].ci95_low, 60e3);
  const auto right = test::identified(scene, curve);
  // Force over Hertz's at 1 mm on 10 mm of skin, nu 0.33: 1.423 (PHYSICS 3.4); less on the way.
  EXPECT_GT(wrong.unknowns[0].estimate, 1.30 * 60e3);
  EXPECT_LT(wrong.unknowns[0].estimate, 1.43 * 60e3);
  EXPECT_TRUE(warns_of_the_model(wrong));
  EXPECT_GT(*wrong.unknowns[0].ci95_low, 60e3);
  EXPECT_EQ(right.scenario.solver.model, scenario::Solver::Model::layer);
  EXPECT_FALSE(warns_of_the_model(right));
  EXPECT_LT(*right.unknowns[0].profile_low, 60e3);
  EXPECT_GT(*right.unknowns[0].profile_high, 60e3);
}

TEST(Identify, ModulusAndPoissonsRatioOfOneCurveAreInseparable) {
  auto scene =
      with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa", "tissue.poisson_ratio=0.2..0.49",
                              "contact_point=-0.1..0.6 mm"});
  const std::string linear = "contact.depth=hertz";
  scene.truth.push_back(linear);
  const auto found =
      test::identified(scene, test::noisy(test::clean_curve(scene), 0.01, 3), {}, {linear});
  EXPECT_TRUE(found.unknowns[0].inseparable);
  EXPECT_TRUE(found.unknowns[1].inseparable);
  EXPECT_FALSE(found.unknowns[2].inseparable);
  const record::Table table = identify::identified_table(found);
  const auto estimate = static_cast<std::size_t>(table.find("estimate"));
  for (const int inseparable : {0, 1})  // no number stands for them
    EXPECT_TRUE(std::holds_alternative<std::monostate>(
        table.rows[static_cast<std::size_t>(inseparable)][estimate]));
  ASSERT_EQ(found.combinations.size(), 1U);
  const identify::Combination& one = found.combinations[0];
  EXPECT_EQ(one.text, "tissue.young_modulus / (1 - tissue.poisson_ratio^2)");
  const double truth = 60.0 / (1.0 - 0.45 * 0.45);
  EXPECT_LT(one.ci95_low, truth);
  EXPECT_GT(one.ci95_high, truth);
  // Determined, for all that: the noise and, on both sides, the stated error of the model.
  EXPECT_LT(one.ci95_high / one.ci95_low, 1.1 * std::exp(2.0 * *found.predicted_error));
}

TEST(Identify, OfACreepOnlyTheRatioOfModulusAndStressIsDetermined) {
  const auto scene =
      with_unknowns("creep", {"tissue.young_modulus=1..500 kPa", "step.1.stress=10..1000 Pa"});
  const auto found =
      test::identified(scene, test::noisy(test::clean_curve(scene), 0.01, 3), {.profiles = false},
                       {"tissue.retardation_time=0.3 s", "solver.model=mass_spring",
                        "solver.integrator=quasi_static"});
  ASSERT_EQ(found.combinations.size(), 1U);
  EXPECT_EQ(found.combinations[0].text, "tissue.young_modulus * step.1.stress^-1");
  EXPECT_NEAR(found.combinations[0].estimate, 8.0 / 0.1,  // both in kPa
              4.0 * found.combinations[0].std_error);
}

// The slopes of a formula and of the scene that it stands for, at a place that is no minimum.
// Central differences of a step d in u err by d^2 / 6 of the third derivative, of a range of e^6
// some 1e-6; those by five points by far less.
TEST(Identify, SlopesAgree) {
  for (const char* name :
       {"hertz", "creep", "relaxation", "compression", "compression over strain"}) {
    const IdentifyScene& scene = test::identify_scene(name);
    const auto curve = test::clean_curve(scene);
    const auto family = scenario::parse(scene.text, "test.toml", {});
    const auto unknowns = identify::read_unknowns(scene.unknowns, family.cases.front().scenario);
    identify::FixedModel fixed{.one = family.cases.front()};
    fixed.one.scenario.output.pressure_maps = false;
    fixed.one.scenario.contact.depth = scenario::Contact::Depth::hertz;
    fixed.one.scenario.solver.integrator = scenario::Solver::Integrator::quasi_static;
    fixed.model = scene.kind == identify::CurveKind::force_travel ? scenario::Model::hertz
                                                                  : scenario::Model::mass_spring;
    identify::ScenarioCurve run(scene.kind, fixed, family, unknowns);
    ASSERT_TRUE(run.has_formula()) << name;
    std::vector<double> x;  // away from the first touch, where the slope has a corner
    for (const double at : curve.x)
      if (scene.kind != identify::CurveKind::force_travel || (at > 0.5e-3 && at < 1.8e-3))
        x.push_back(at);
    run.set_points(x);
    const std::vector<double> zeros(x.size(), 0.0);
    const std::vector<double> ones(x.size(), 1.0);
    identify::BoxProblem problem;
    problem.unknowns = unknowns.size();
    problem.measured = zeros;
    problem.weights = ones;
    problem.curve = [&](std::span<const double> at, std::span<double> out) {
      return run.evaluate(at, out);
    };
    const std::vector<double> u(unknowns.size(), 0.4);
    const auto central = identify::evaluate_in_box(problem, u);
    problem.curve = [&](std::span<const double> at, std::span<double> out) {
      return run.run(at, out);
    };
    const auto scene_slopes = identify::evaluate_in_box(problem, u);
    ASSERT_TRUE(central.found && scene_slopes.found) << name;
    // By five points, with an error of order h^4.
    dense::Rows five_points = dense::Rows::Zero(central.jacobian.rows(), central.jacobian.cols());
    for (std::size_t k = 0; k < u.size(); ++k)
      for (const auto& [steps, factor] : {std::pair{-2, 1.0}, {-1, -8.0}, {1, 8.0}, {2, -1.0}}) {
        constexpr double h = 1e-3;
        std::vector<double> moved = u;
        moved[k] += steps * h;
        std::vector<double> values(x.size());
        ASSERT_TRUE(run.evaluate(moved, values));
        for (std::size_t i = 0; i < x.size(); ++i)
          five_points(Eigen::Index(i), Eigen::Index(k)) += factor * values[i] / (12.0 * h);
      }
    const double largest = five_points.cwiseAbs().maxCoeff();
    const auto farthest = [&](const dense::Rows& slopes) {
      return (slopes - five_points).cwiseAbs().maxCoeff();
    };
    EXPECT_LE(farthest(central.jacobian), 1e-6 * largest) << name;
    // The scene: between rows a creep is a line, of (20 ms / tau)^2 / 8 at the tau of u = 0.4.
    EXPECT_LE(farthest(scene_slopes.jacobian), 1e-3 * largest) << name;
  }
}

// Of one linear unknown the profile is a parabola: its ends are Student's.
TEST(Identify, ProfileOfALinearUnknownIsStudents) {
  const auto scene = with_unknowns("hertz", {"force_offset=-0.5..0.5 N"});
  IdentifyScene still = scene;
  still.contact_point = 0.0;
  const auto found = test::identified(still, test::noisy(test::clean_curve(still), 0.01, 5), {},
                                      {"tissue.young_modulus=60 kPa"});
  const identify::Identified& one = found.unknowns[0];
  const double width = *one.ci95_high - *one.ci95_low;
  EXPECT_NEAR(*one.profile_low, *one.ci95_low, 1e-4 * width);  // false position, of a line
  EXPECT_NEAR(*one.profile_high, *one.ci95_high, 1e-4 * width);
  EXPECT_FALSE(one.by_profile);
}

// Where residuals are correlated, Student's t has fewer degrees of freedom, and the line at which a
// profile ends is that of the intervals.
TEST(Identify, ProfileEndsAtTheIntervalsThreshold) {
  IdentifyScene scene = with_unknowns("hertz", {"force_offset=-0.5..0.5 N"});
  scene.contact_point = 0.0;
  scene.text.replace(scene.text.find("10 ms"), 5, "1 ms");
  const auto found = test::identified(scene, test::noisy(test::clean_curve(scene), 0.01, 5, 0.9),
                                      {}, {"tissue.young_modulus=60 kPa"});
  const identify::Identified& one = found.unknowns[0];
  ASSERT_GT(found.rho, 0.5);
  const double t = (*one.ci95_high - one.estimate) / *one.std_error;
  EXPECT_NEAR(found.threshold, t * t, 1e-6 * t * t);
  const auto table = identify::profile_table(found);
  EXPECT_EQ(std::get<double>(table.rows.at(0).at(4)), found.threshold);
  // 100 means of neighbours are judged: t of 99 degrees is 1.9842, of 400 1.9659.
  EXPECT_NEAR(t, 1.9842, 1e-4);
  // So many independent rows give this error of a mean.
  EXPECT_NEAR(found.effective_size, std::pow(found.noise / *one.std_error, 2),
              1e-6 * found.effective_size);
}

// A press whose scenario names no body is judged with the default block, which is said, with what a
// half-space would change.
TEST(Identify, SaysWhichBodyItTakesUnasked) {
  const IdentifyScene unnamed{
      "block",
      "[tissue]\nviscosity = \"none\"\n" + test::rigid + test::press_2mm + test::rows_10ms,
      {"tissue.young_modulus=60 kPa"},
      {"tissue.young_modulus=1..500 kPa"},
      {60e3},
      identify::CurveKind::force_travel};
  IdentifyScene half = unnamed;
  half.text.replace(0, 9, "[tissue]\nshape = { kind = \"half_space\" }\n");
  half.truth.emplace_back("contact.depth=neo_hookean");  // as the block takes it by itself
  const identify::Measurement on_block = test::clean_curve(unnamed);
  const double more = on_block.y.back() / test::clean_curve(half).y.back() - 1.0;
  ASSERT_GT(more, 0.02);
  const auto said = [](const identify::Identification& found) { return joined(found.notes, "\n"); };
  const auto found = test::identified(unnamed, on_block, {.profiles = false});
  EXPECT_NE(said(found).find("the default block, 60 by 60 by 30 mm, on which the force at the "
                             "deepest is " +
                             percent_text(more) + " larger than on a half-space"),
            std::string::npos)
      << said(found);
  EXPECT_EQ(said(test::identified(half, on_block, {.profiles = false})).find("default block"),
            std::string::npos);
  // So it is over time, where the curve ends after the finger has left the body.
  IdentifyScene timed = unnamed;
  timed.text += "[[step]]\nkind = \"retract\"\nrate = \"5 mm/s\"\n";
  timed.kind = identify::CurveKind::force_time;
  const auto over_time = test::identified(timed, test::clean_curve(timed), {.profiles = false});
  EXPECT_NE(said(over_time).find("larger than on a half-space, and the intervals"),
            std::string::npos)
      << said(over_time);
  // A specimen that is a half-space after all is in the interval.
  const auto other =
      test::identified(unnamed, test::clean_curve(half), {.profiles = false}).unknowns[0];
  EXPECT_LT(other.estimate, 60e3 * (1.0 - 0.5 * more));
  EXPECT_LT(*other.ci95_low, 60e3);
  EXPECT_GT(*other.ci95_high, 60e3);
}

// 3 N/m on the curve of a press from a displacement of 0.
TEST(Identify, FitsATiltOfTheBaseline) {
  IdentifyScene scene =
      with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa", "force_tilt=-10..10 N/m"});
  scene.contact_point = 0.0;
  identify::Measurement curve = test::clean_curve(scene);
  for (std::size_t i = 0; i < curve.x.size(); ++i) curve.y[i] += 3.0 * curve.x[i];
  const auto found = test::identified(scene, curve, {.profiles = false});
  EXPECT_NEAR(found.unknowns[0].estimate, 60e3, 60.0);
  EXPECT_NEAR(found.unknowns[1].estimate, 3.0, 0.03);
  EXPECT_NE(joined(found.notes, "\n").find("contact is taken to begin at 0"), std::string::npos);
  const IdentifyScene relax = with_unknowns("relaxation", {"force_tilt=-1..1 N/m"});
  EXPECT_NE(
      refusal(relax, test::clean_curve(relax)).find("`--unknown force_tilt` is the slope of a"),
      std::string::npos);
}

// Of several loadings the first is fitted, a specimen that gives way ends the curve, and a way back
// alone is refused.
TEST(Identify, TakesTheFirstLoadingUpToARupture) {
  IdentifyScene scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa"});
  scene.contact_point = 0.0;
  scene.text.replace(scene.text.find("10 ms"), 5, "1 ms");
  const identify::Measurement clean = test::clean_curve(scene);
  const auto says = [](const identify::Identification& found, const char* words) {
    return std::any_of(found.notes.begin(), found.notes.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    });
  };
  const auto add_back = [&](identify::Measurement& to, double share) {
    for (std::size_t i = clean.x.size(); i-- > 0;) {
      to.x.push_back(clean.x[i]);
      to.y.push_back(share * clean.y[i]);
    }
  };
  identify::Measurement cycles = clean;
  add_back(cycles, 0.8);
  for (std::size_t i = 0; i < clean.x.size(); ++i) {
    cycles.x.push_back(clean.x[i]);
    cycles.y.push_back(0.9 * clean.y[i]);
  }
  auto found = test::identified(scene, cycles);
  EXPECT_TRUE(says(found, "the first of 2 loadings is fitted"));
  EXPECT_NEAR(found.unknowns[0].estimate, 60e3, 60.0);
  // The intervals contain the model's stated error, without which exact data have none.
  const auto sentence = [&](bool model_error) {
    return identify::identified_sentences(
        test::identified(scene, clean, {.model_error = model_error, .profiles = false}))[0];
  };
  EXPECT_NE(sentence(true).find("60 kPa  (95 %: 5"), std::string::npos) << sentence(true);
  EXPECT_NE(sentence(false).find("exact to rounding"), std::string::npos) << sentence(false);

  identify::Measurement torn = clean;
  for (std::size_t i = 300; i < torn.y.size(); ++i) torn.y[i] *= 0.3;
  found = test::identified(scene, torn);
  EXPECT_TRUE(says(found, "beyond the largest load, from which it falls by over 10 %"));
  EXPECT_NEAR(found.unknowns[0].estimate, 60e3, 60.0);

  identify::Measurement back = clean;
  back.x.clear();
  back.y.clear();
  add_back(back, 1.0);
  EXPECT_NE(test::refusal([&] {
              (void)test::identified(scene, back);
            }).find("these are rows of the way back"),
            std::string::npos);
}

// A force that is rounded to steps of 4 % has no scatter within a step, and an error all the same.
TEST(Identify, RoundedForcesWidenTheInterval) {
  IdentifyScene scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa"});
  scene.contact_point = 0.0;
  scene.text.replace(scene.text.find("10 ms"), 5, "1 ms");
  identify::Measurement curve = test::clean_curve(scene);
  const double step = 0.04 * curve.y.back();
  for (double& y : curve.y) y = step * std::round(y / step);
  const auto found = test::identified(scene, curve);
  const identify::Identified& one = found.unknowns[0];
  // One error, uniform over a step, for each run of equal rows: the variance of ln E is
  // step^2/12 sum_runs (sum F)^2 / (sum F^2)^2, with F the model's force.
  double squares = 0.0, runs = 0.0, run = 0.0;
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    squares += found.model[i] * found.model[i];
    if (i > 0 && curve.y[i] != curve.y[i - 1]) {
      runs += run * run;
      run = 0.0;
    }
    run += found.model[i];
  }
  runs += run * run;
  EXPECT_GT(*one.std_error / one.estimate, std::sqrt(step * step / 12.0 * runs) / squares);
}

// With F = c h^(3/2) over evenly spaced h up to H, least squares give
// d ln E = dh0 sum F dF/dh / sum F^2 = 3/2 (H^3 / 3) / (H^4 / 4) dh0 = 2 dh0 / H.
TEST(Identify, ContactPointMovesTheModulus) {
  const auto scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa"});
  IdentifyScene still = scene;
  still.contact_point = 0.0;
  const auto found = test::identified(still, test::noisy(test::clean_curve(still), 0.01, 5));
  EXPECT_NEAR(found.contact_shift, 0.05e-3, 1e-9);  // a row every 10 ms at 5 mm/s
  const double later = *found.unknowns[0].moved_up / found.unknowns[0].estimate;
  const double earlier = *found.unknowns[0].moved_down / found.unknowns[0].estimate;
  // To first order; the integrals stand for sums over 41 points.
  EXPECT_NEAR(0.5 * (later - earlier), 2.0 * 0.05 / 2.0, 0.03 * 0.05);
  EXPECT_GT(later, 0.0);
  EXPECT_LT(earlier, 0.0);
}

// The record begins one row after the step, and its first row is taken as the step.
TEST(Identify, AStepBetweenTwoRowsIsInTheInterval) {
  const test::IdentifyScene scene = test::identify_scene("relaxation");
  identify::Measurement late = test::noisy(test::clean_curve(scene), 0.0005, 3);
  const double gap = late.x[1] - late.x[0];
  late.x.pop_back();
  late.y.erase(late.y.begin());
  const auto contained = [&] {
    const auto found = test::identified(scene, late, {.searches = 1});
    for (std::size_t i = 0; i < found.unknowns.size(); ++i)
      if (found.unknowns[i].unknown.key == "tissue.instantaneous_ratio") {
        const identify::Interval interval = identify::trusted(found.unknowns[i]);
        return *interval.low <= scene.true_values[i] && scene.true_values[i] <= *interval.high;
      }
    return false;
  };
  EXPECT_FALSE(contained());
  late.starts = {-gap};
  EXPECT_TRUE(contained());
}

TEST(Identify, RefusesWhatTheDataCannotAnswer) {
  const IdentifyScene& scene = test::identify_scene("hertz");
  identify::Measurement curve = test::clean_curve(scene);
  identify::Measurement few = curve;
  few.x.resize(2);
  few.y.resize(2);
  EXPECT_EQ(
      refusal(scene, few),
      "palpate: 2 usable points cannot determine 2 unknowns and the noise; record more points, or "
      "remove an `--unknown`");
  identify::Measurement flat = curve;
  std::fill(flat.y.begin(), flat.y.end(), 0.5);
  EXPECT_NE(refusal(scene, flat).find("is the same at every point"), std::string::npos);
  const auto idle = with_unknowns("hertz", {"contact.friction=0.1..1"});
  EXPECT_NE(refusal(idle, curve)
                .find("`--unknown contact.friction` changes nothing in what "
                      "`hertz` computes"),
            std::string::npos);
  const auto outside = with_unknowns("hertz", {"tissue.young_modulus=1..10 kPa"});
  EXPECT_NE(refusal(outside, curve).find("the best fit lies at the edge"), std::string::npos);
  const auto noise = test::noisy(curve, 50.0, 4);
  EXPECT_NE(
      refusal(with_unknowns("hertz", {"tissue.young_modulus=50..70 kPa"}), noise).find("palpate: "),
      std::string::npos);
  identify::Measurement other = curve;
  other.y_dimension = unit::kPa.dimension;
  EXPECT_NE(refusal(scene, other).find("is no curve of this scenario"), std::string::npos);
}

TEST(Identify, SaysWhichPointsAreLeftOut) {
  const IdentifyScene& scene = test::identify_scene("hertz");
  identify::Measurement curve = test::clean_curve(scene);
  const std::size_t points = curve.x.size();
  for (std::size_t i = points; i-- > 0;) {  // and back
    curve.x.push_back(curve.x[i]);
    curve.y.push_back(curve.y[i]);
  }
  const auto found = test::identified(scene, curve, {.profiles = false});
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0], std::to_string(points) +
                                " points are excluded: the way back from the largest displacement");
  EXPECT_EQ(found.excluded, static_cast<int>(points));
  EXPECT_EQ(found.x.size(), points);  // up to 2.2 mm, where the deepest stands twice
}

// A hold that goes on for longer than the scenario's is lengthened; a finger that leaves ends it.
TEST(Identify, ALongerHoldIsLengthenedAndAWithdrawalIsLeftOut) {
  const IdentifyScene& scene = test::identify_scene("viscous branch");
  const identify::Measurement curve = test::clean_curve(scene);
  for (const double part : {0.8, 0.0}) {
    identify::Measurement longer = curve;
    for (int i = 1; i <= 20; ++i) {
      longer.x.push_back(curve.x.back() + 0.02 * i);
      longer.y.push_back(part * curve.y.back());
    }
    const auto found = test::identified(scene, longer, {.searches = 1, .profiles = false});
    EXPECT_EQ(found.excluded, part == 0.0 ? 20 : 0);
  }
}

// The scenario that gives the fitted curve has the reading of the cell without load.
TEST(Identify, TheOffsetIsInTheScenario) {
  const auto scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa",
                                             "contact_point=-0.1..0.6 mm", "force_offset=-1..1 N"});
  identify::Measurement curve = test::clean_curve(scene);
  for (double& each : curve.y) each += 0.05;
  const auto found = test::identified(scene, curve, {.searches = 1, .profiles = false});
  EXPECT_NEAR(found.scenario.contact.ambient_force, 0.05, 1e-5);  // rows are interpolated to that
}

// Of a compression and its hold, over time all points are taken and the programme is long enough;
// over strain the hold is excluded.
TEST(Identify, TakesACompressionOverTimeOrStrain) {
  const IdentifyScene& over_time = test::identify_scene("compression");
  const auto whole = test::identified(over_time, test::clean_curve(over_time), {.profiles = false});
  EXPECT_TRUE(whole.notes.empty()) << whole.notes.front();
  for (std::size_t i = 0; i < over_time.true_values.size(); ++i)
    EXPECT_NEAR(whole.unknowns[i].estimate, over_time.true_values[i],
                1e-6 * over_time.true_values[i]);

  const IdentifyScene& over_strain = test::identify_scene("compression over strain");
  const identify::Measurement curve = test::clean_curve(over_strain);
  const auto loading = test::identified(over_strain, curve, {.profiles = false});
  EXPECT_EQ(loading.excluded + static_cast<int>(loading.x.size()),
            static_cast<int>(curve.x.size()));
  EXPECT_GT(loading.excluded, static_cast<int>(loading.x.size()));
  EXPECT_NEAR(loading.unknowns[0].estimate, over_strain.true_values[0],
              1e-6 * over_strain.true_values[0]);
}

// The programme of the scenario ends at a quarter of the measured travel, and the range of contact
// points begins 3 mm before it.
TEST(Identify, AShortProgrammeIsLengthened) {
  auto scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa"});
  scene.truth.emplace_back("contact.depth=hertz");
  const auto curve = test::clean_curve(scene);
  scene.unknowns.emplace_back("contact_point=-3..1 mm");
  const auto found = test::identified(scene, curve, {.profiles = false},
                                      {"step.1.to=0.5 mm", "contact.depth=hertz"});
  EXPECT_EQ(found.x.size(), curve.x.size());
  EXPECT_EQ(found.excluded, 0);
  EXPECT_NEAR(found.unknowns[0].estimate, 60e3, 1e-6 * 60e3);  // exact data
  ASSERT_FALSE(found.notes.empty());
  EXPECT_TRUE(
      found.notes[0].starts_with("the loading history is shorter than the measurement and is "
                                 "lengthened to "))
      << found.notes[0];
}

// E is proportional to R^(-1/2): a radius known to 2 % leaves E uncertain by 1 %.
TEST(Identify, AnUncertainRadiusWidensTheInterval) {
  const auto scene = with_unknowns("hertz", {"tissue.young_modulus=1..500 kPa"});
  auto curve = test::clean_curve(scene);
  for (double& x : curve.x) x -= scene.contact_point;
  auto family = scenario::parse(scene.text, "test.toml", {"contact.depth=hertz"});
  const auto unknowns = identify::read_unknowns(scene.unknowns, family.cases.front().scenario);
  const auto givens = identify::read_givens({"finger.radius=11 mm +- 0.22 mm"},
                                            family.cases.front().scenario, unknowns);
  identify::set_givens(family, givens);
  auto found = identify::identify(curve, family, unknowns, {.profiles = false});
  const double estimate = found.unknowns[0].estimate;
  const double before = *found.unknowns[0].std_error;
  identify::carry_givens(found, curve, family, givens, identify::Noise::constant);
  ASSERT_EQ(found.givens.size(), 1U);
  const double part = found.givens[0].deviations[0];
  EXPECT_NEAR(part / estimate, 0.01, 1e-5);  // half of 2 %, to second order in 2 %
  EXPECT_NEAR(*found.unknowns[0].std_error, std::hypot(before, part), 1e-9 * estimate);  // rounding
  EXPECT_GT(*found.unknowns[0].ci95_high, estimate * 1.0195);
  EXPECT_EQ(test::refusal([&] {
              return identify::read_givens({"finger.radius=11 mm"}, family.cases.front().scenario,
                                           unknowns);
            }),
            "palpate: `--given finger.radius=11 mm` is written `KEY=VALUE +- SD`, as "
            "`finger.radius=11 mm +- 0.2 mm`");
}

// A curve that an interrupt excludes looks like one that the data do not determine. Whenever the
// interrupt comes, there is the whole result or none.
TEST(Identify, AnInterruptLeavesTheWholeResultOrNone) {
  const IdentifyScene& scene = test::identify_scene("creep of springs");
  const auto curve = test::noisy(test::clean_curve(scene), 0.01, 1);
  const auto family = scenario::parse(scene.text, "test.toml", {});
  const auto unknowns = identify::read_unknowns(scene.unknowns, family.cases.front().scenario);
  const auto table = [&](const std::atomic<bool>& stop) {
    const StopScope scope(stop);
    const auto found = identify::identify(curve, family, unknowns);
    return record::csv_text(identify::identified_table(found)) +
           record::csv_text(identify::profile_table(found));
  };
  const auto start = std::chrono::steady_clock::now();
  const std::string whole = table(false);
  const auto duration = std::chrono::steady_clock::now() - start;
  int refused = 0;
  for (int part = 0; part < 10; ++part) {
    std::atomic<bool> stop = part == 0;
    std::thread user([&] {
      std::this_thread::sleep_for(duration * part / 10);
      stop = true;
    });
    try {
      EXPECT_EQ(table(stop), whole) << part << "/10 of the time";
    } catch (const InputError&) {
      ++refused;
    } catch (const Stopped&) {
      ++refused;
    }
    user.join();
  }
  EXPECT_GT(refused, 0);  // at least the first
}

}  // namespace
}  // namespace palpate
