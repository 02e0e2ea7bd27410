// Which rows of a measurement are used, with which weights, and what an unknown of a sensor needs.
#include "identify/prepare_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.h"
#include "refusal.h"

namespace palpate::identify {
namespace {

const std::string ball =
    "[tissue]\nshape = { kind = \"half_space\" }\npoisson_ratio = 0.45\n[finger]\nmaterial = "
    "\"rigid\"\nradius = \"11 mm\"\n[contact]\ndepth = \"hertz\"\n[solver]\nmodel = \"hertz\"\n";
const std::string muscle_column =
    "[tissue]\nmaterial = \"muscle\"\nviscosity = \"standard_linear_solid\"\nshape = { kind = "
    "\"cuboid\", size = [\"30 mm\", \"30 mm\", \"30 mm\"] }\n";

struct Prepared {
  scenario::Family family;
  std::vector<Unknown> unknowns;
  PreparedCurve curve;

  Prepared(const std::string& text, const Measurement& measured,
           const std::vector<std::string>& asked, Noise noise = Noise::constant)
      : family(scenario::parse(text, "t.toml", {})),
        unknowns(read_unknowns(asked, family.cases.front().scenario)),
        curve(prepare_curve(measured, family, unknowns, noise)) {}
};

Measurement rising_press(int rows, double deepest) {
  Measurement made{.x = {},
                   .y = {},
                   .x_name = "travel",
                   .y_name = "force",
                   .x_dimension = {1, 0, 0},
                   .y_dimension = {1, 1, -2}};
  for (int i = 0; i < rows; ++i) {
    made.x.push_back(deepest * i / (rows - 1));
    made.y.push_back(std::pow(made.x.back() / deepest, 1.5));
  }
  return made;
}

const std::string to_2_mm = "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"1 mm/s\"\n";
const std::vector<std::string> young_only{"tissue.young_modulus=5..500 kPa"};

TEST(PrepareCurve, SensorsNeedTheirCurve) {
  const auto refused = [](const std::string& text, const Measurement& measured,
                          const std::string& unknown) {
    return test::refusal([&] { (void)Prepared(text, measured, {young_only[0], unknown}); });
  };
  EXPECT_NE(refused(ball + to_2_mm, rising_press(50, 2e-3), "force_delay=0..1 s")
                .find("`--unknown force_delay` shifts a force over time"),
            std::string::npos);
  Measurement relaxes = rising_press(50, 1.0);
  relaxes.x_dimension = {0, 0, 1};
  relaxes.y_dimension = {-1, 1, -2};
  const std::string relax =
      muscle_column + "[[step]]\nkind = \"relax\"\nstrain = 0.02\ntime = \"1 s\"\n";
  EXPECT_NE(refused(relax, relaxes, "force_offset=-1..1 N")
                .find("`--unknown force_offset` is added to a force"),
            std::string::npos);
  EXPECT_NE(refused(relax, relaxes, "contact_point=0..1 mm")
                .find("`--unknown contact_point` shifts a displacement"),
            std::string::npos);
}

// A press that ends at a force is computed to the depth of the measurement, from the earliest
// contact on.
TEST(PrepareCurve, APressToAForceReachesTheDeepestRow) {
  const std::string to_force =
      ball + "[[step]]\nkind = \"indent\"\nto = \"1 N\"\nrate = \"1 mm/s\"\n";
  const Prepared made(to_force, rising_press(50, 2e-3),
                      {young_only[0], "contact_point=-1..0.5 mm"});
  const auto& step = std::get<scenario::Indent>(made.curve.curve->fixed().steps.front());
  EXPECT_FALSE(step.to.second);
  EXPECT_NEAR(step.to.value, 3e-3, 1e-8);  // 2 mm and 1 mm, and a margin of 1e-6
  EXPECT_EQ(made.curve.found.excluded, 0);
}

// The last row may lie beyond the end by rounding, without a longer history.
TEST(PrepareCurve, RoundingIsNoLongerHistory) {
  Measurement measured = rising_press(50, 1.0);
  measured.x_dimension = {0, 0, 1};
  measured.y_dimension = {-1, 1, -2};
  std::reverse(measured.y.begin(), measured.y.end());
  measured.x.back() *= 1.0 + 1e-12;
  const std::string relax =
      muscle_column + "[[step]]\nkind = \"relax\"\nstrain = 0.02\ntime = \"1 s\"\n";
  const Prepared made(relax, measured, young_only);
  EXPECT_EQ(made.curve.found.excluded, 0);
  EXPECT_TRUE(made.curve.found.notes.empty()) << made.curve.found.notes.front();
  // A load that goes on to fall is still that of the hold.
  measured.x.push_back(3.0);
  measured.y.push_back(0.0);
  const Prepared longer(relax, measured, young_only);
  EXPECT_EQ(longer.curve.found.excluded, 0);
  EXPECT_NE(joined(longer.curve.found.notes, "\n").find("is lengthened to 3 s"), std::string::npos);
}

// The strain of a hold is noisy: the loading ends where it reaches a thousandth of its largest.
TEST(PrepareCurve, AHoldBeginsWithinAThousandth) {
  Measurement measured;
  measured.x_name = "strain";
  measured.y_name = "stress";
  measured.y_dimension = {-1, 1, -2};
  for (int i = 0; i < 100; ++i) {
    measured.x.push_back(i <= 50 ? 0.002 * i : 0.1 + 1e-5 * (i == 80 ? 3 : -1));
    measured.y.push_back(1e3 * (i <= 50 ? 0.02 * i : 1.0 - 0.004 * (i - 50)));
  }
  const std::string compress =
      muscle_column + "[[step]]\nkind = \"compress\"\nstrain = 0.1\nrate = \"0.2 1/s\"\n";
  const Prepared made(compress, measured, young_only);
  EXPECT_EQ(made.curve.found.x.size(), 51U);
}

// Equal values in the middle of a curve are no limit of a sensor.
TEST(PrepareCurve, ALimitIsAtTheEnd) {
  Measurement measured = rising_press(100, 2e-3);
  for (std::size_t i = 50; i < 100; ++i) measured.y[i] = i < 80 ? 0.5 : 0.49 - 1e-4 * (i - 80.0);
  EXPECT_EQ(Prepared(ball + to_2_mm, measured, young_only).curve.found.excluded, 0);
  for (std::size_t i = 80; i < 100; ++i) measured.y[i] = 0.5;
  EXPECT_EQ(Prepared(ball + to_2_mm, measured, young_only).curve.found.excluded, 50);
}

// Relative noise has a floor at a hundredth of the largest value, and a mean of n rows counts n
// times.
TEST(PrepareCurve, Weights) {
  const Prepared relative(ball + to_2_mm, rising_press(100, 2e-3), young_only, Noise::relative);
  EXPECT_NEAR(*std::max_element(relative.curve.weights.begin(), relative.curve.weights.end()),
              100.0, 1e-9);
  EXPECT_NEAR(relative.curve.weights.back(), 1.0, 1e-9);
  // The rows before contact are straight, and blocks are halved where the force bends.
  Measurement longer = rising_press(7000, 2e-3);
  for (std::size_t i = 0; i < longer.x.size(); ++i)
    longer.y[i] = std::pow(std::max(longer.x[i] / 2e-3 - 0.5, 0.0), 1.5);
  longer.y[3000] = 0.2;  // and at a jump
  const Prepared averaged(ball + to_2_mm, longer, young_only);
  double rows = 0.0;
  const double most =
      *std::max_element(averaged.curve.weights.begin(), averaged.curve.weights.end());
  for (const double weight : averaged.curve.weights)
    rows += weight * weight / (most * most) * averaged.curve.rows_each;
  EXPECT_NEAR(rows, 7000.0, 1e-6);
  EXPECT_LT(*std::min_element(averaged.curve.weights.begin(), averaged.curve.weights.end()),
            0.9 * most);
}

// A slide begins with no tangential force, wherever its first row lies.
TEST(ScenarioCurve, ASlideBeginsAtZero) {
  Measurement measured = rising_press(50, 1.5e-3);
  measured.y_name = "tangential force";
  const Prepared made(ball +
                          "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[[step]]\nkind = "
                          "\"slide\"\nby = \"2 mm\"\nrate = \"5 mm/s\"\n",
                      measured, {"contact.friction=0.1..1"});
  made.curve.curve->set_points({0.0, 1e-6, 1e-3});
  std::vector<double> force(3);
  ASSERT_TRUE(made.curve.curve->evaluate(std::vector{0.5}, force));
  EXPECT_EQ(force[0], 0.0);
  EXPECT_GT(force[2], 0.0);
  EXPECT_LT(force[1], 0.1 * force[2]);
}

// A tilt is over the displacement as measured, before contact and beyond.
TEST(ScenarioCurve, ATiltBeginsAtTheDisplacementsZero) {
  const Prepared made(ball + to_2_mm, rising_press(50, 2e-3),
                      {"contact_point=0..1 mm", "force_tilt=-10..10 N/m"});
  made.curve.curve->set_points({0.2e-3, 1.5e-3});
  std::vector<double> without(2), with(2);
  ASSERT_TRUE(made.curve.curve->evaluate(std::vector{0.5, 0.5}, without));
  ASSERT_TRUE(made.curve.curve->evaluate(std::vector{0.5, 0.65}, with));
  EXPECT_NEAR(with[0] - without[0], 3.0 * 0.2e-3, 1e-12);
  EXPECT_NEAR(with[1] - without[1], 3.0 * 1.5e-3, 1e-12);
}

// Only what the formulas of a press on a half-space and of a sliding column describe has one.
TEST(ScenarioCurve, HasAClosedFormOfWhatTheFormulaDescribes) {
  const auto closed = [](std::string text, const std::string& from, const std::string& to,
                         const std::vector<std::string>& asked, bool over_strain = false) {
    if (const auto at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
    Measurement measured = rising_press(50, over_strain ? 0.02 : 2e-3);
    if (over_strain) {
      measured.x_dimension = {};
      measured.y_dimension = {-1, 1, -2};
    }
    return Prepared(text, measured, asked).curve.curve->has_formula();
  };
  const std::string press_text = ball + to_2_mm;
  EXPECT_TRUE(closed(press_text, "", "", young_only));
  EXPECT_FALSE(
      closed(press_text, "\"half_space\"", "\"half_space\", curvature = \"10 1/m\"", young_only));
  EXPECT_FALSE(closed(press_text, "poisson_ratio = 0.45\n",
                      "poisson_ratio = 0.45\nviscosity = \"standard_linear_solid\"\n", young_only));
  EXPECT_FALSE(closed(press_text, "depth = \"hertz\"", "depth = \"neo_hookean\"", young_only));
  EXPECT_FALSE(closed(press_text, "depth = \"hertz\"",
                      "depth = \"hertz\"\nambient_force = \"0.1 N\"",
                      {young_only[0], "force_offset=-1..1 N"}));
  const std::string squeeze =
      "[tissue]\nmaterial = \"muscle\"\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = "
      "[\"30 mm\", \"30 mm\", \"30 mm\"] }\n[[step]]\nkind = \"compress\"\nstrain = 0.02\nrate = "
      "\"0.2 1/s\"\n";
  EXPECT_TRUE(closed(squeeze, "", "", young_only, true));
  EXPECT_FALSE(closed(squeeze, "viscosity", "base = \"bonded\"\nviscosity", young_only, true));
  EXPECT_FALSE(
      closed(squeeze, "strain = 0.02", "strain = 0.02\nplaten = \"bonded\"", young_only, true));
}

}  // namespace
}  // namespace palpate::identify
