// What is no design of [sweep], or makes no sensible cases, is refused before the first case runs.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "base/text.h"
#include "refusal.h"
#include "scenario/family.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

// A whole family and an outline refuse the same.
std::string said(const std::string& sweep, const std::string& scenario = small_press) {
  const std::string text = scenario + "[sweep]\n" + sweep;
  const std::string made = test::refusal([&] { return parse(text, "press.toml", {}); });
  const std::string planned = test::refusal([&] { return outline_text(text, "press.toml", {}); });
  EXPECT_EQ(made, planned);
  return made;
}

struct RefusedSweep {
  const char* sweep;
  const char* sentence;
};

const char* const young = "\"tissue.young_modulus\" = ";

TEST(Refused, Designs) {
  const RefusedSweep cases[] = {
      {"design = \"sobel\"\n",
       "press.toml:5:10: `design` does not know `sobel`; did you mean `sobol`? It is one of grid, "
       "lhs, sobol, saltelli, list, csv"},
      {"design = 3\n",
       "press.toml:5:10: `design` wants one of grid, lhs, sobol, saltelli, list, csv, got an "
       "integer; write it as `design = \"grid\"`"},
      {"design = \"lhs\"\n\"contact.friction\" = { from = 0, to = 1 }\n",
       "press.toml:5:10: `design = \"lhs\"` lacks `samples`; write `samples = 100`"},
      {"design = \"sobol\"\nsamples = 10\n",
       "press.toml:5:10: `design = \"sobol\"` has nothing to vary; add a key, as "
       "`\"tissue.young_modulus\" = { from = \"1 kPa\", to = \"100 kPa\" }`"},
      {"samples = 10\n",
       "press.toml:5:1: `samples` has no effect here: it is used only with `design = \"lhs\"`, "
       "`\"sobol\"` or `\"saltelli\"`; remove it or change that"},
      {"design = \"sobol\"\nsamples = 4\nseed = 1\n",
       "press.toml:7:1: `seed` has no effect here: it is used only with `design = \"lhs\"`; remove "
       "it or change that"},
      {"file = \"cases.csv\"\n",
       "press.toml:5:1: `file` has no effect here: it is used only with `design = \"csv\"`; remove "
       "it or change that"},
      {"design = \"lhs\"\nsamples = 0\n",
       "press.toml:6:11: `samples` wants a whole number from 1 to 10000000, got `0`; write "
       "`samples = 100`"},
      {"design = \"lhs\"\nsamples = -5\n",
       "press.toml:6:11: `samples` wants a whole number from 1 to 10000000, got `-5`; write "
       "`samples = 100`"},
      {"design = \"lhs\"\nsamples = nan\n",
       "press.toml:6:11: `samples` wants a whole number from 1 to 10000000, got `nan`; write "
       "`samples = 100`"},
      {"design = \"lhs\"\nsamples = 9223372036854775807\n",
       "press.toml:6:11: `samples` wants a whole number from 1 to 10000000, got "
       "`9223372036854775808`; write `samples = 100`"},
      {"design = \"lhs\"\nsamples = 2\nseed = -1\n",
       "press.toml:7:8: `seed` wants a whole number from 0 to 9007199254740991, got `-1`; write "
       "`seed = 1`"},
      {"\"finger.radius\" = { from = \"8 mm\", to = \"9 mm\", points = 1000000 }\n"
       "\"contact.friction\" = { from = 0, to = 1, points = 1000000 }\n",
       "press.toml:4:1: `sweep` makes 1e+12 cases, and 1e+09 is the most; give shorter lists or "
       "several scenarios"},
  };
  for (const auto& [sweep, sentence] : cases) EXPECT_EQ(said(sweep), sentence) << sweep;
}

TEST(Refused, Ranges) {
  const RefusedSweep cases[] = {
      {"{ from = \"1 kPa\", to = \"9 kPa\" }",
       "press.toml:5:26: `tissue.young_modulus` lacks `points`, which `design = \"grid\"` needs; "
       "write `points = 20` beside `to`"},
      {"{ from = \"1 kPa\", points = 3 }",
       "press.toml:5:26: the range of `tissue.young_modulus` lacks `to`; write `{ from = ..., to = "
       "... }`"},
      {"{ to = \"1 kPa\", points = 3 }",
       "press.toml:5:26: the range of `tissue.young_modulus` lacks `from`; write `{ from = ..., to "
       "= ... }`"},
      {"{ from = \"1 kPa\", to = \"9 kPa\", point = 3 }",
       "press.toml:5:58: `point` is not a key here; did you mean `points`?"},
      {"{ from = \"1 kPa\", to = \"9 kPa\", points = 1 }",
       "press.toml:5:67: `points` wants a whole number from 2 to 1000000, got `1`; write `points = "
       "20`"},
      {"{ from = \"1 kPa\", to = \"9 kPa\", points = 2.5 }",
       "press.toml:5:67: `points` wants a whole number from 2 to 1000000, got `2.5`; write `points "
       "= 20`"},
      {"{ from = \"1 kPa\", to = \"9 kPa\", points = 9999999999 }",
       "press.toml:5:67: `points` wants a whole number from 2 to 1000000, got `9999999999`; write "
       "`points = 20`"},
      {"{ from = \"1 kPa\", to = \"9 kPa\", points = 3, scale = \"ln\" }",
       "press.toml:5:78: `scale` is `\"linear\"` or `\"log\"`, got `ln`; write one of the two"},
      {"{ from = \"0 kPa\", to = \"9 kPa\", points = 3, scale = \"log\" }",
       "press.toml:5:35: a logarithmic scale has no place for `0 kPa`; begin above 0, or write "
       "`scale = \"linear\"`"},
      {"{ from = \"1 kPa\", to = \"-9 kPa\", points = 3, scale = \"log\" }",
       "press.toml:5:49: a logarithmic scale has no place for `-9 kPa`; begin above 0, or write "
       "`scale = \"linear\"`"},
      {"{ from = \"1 kPa\", to = \"9 MPa\", points = 3 }",
       "press.toml:5:49: `from` has `kPa` and `to` `MPa`; write both in one unit"},
      {"{ from = \"1 kPa\", to = 9, points = 3 }",
       "press.toml:5:49: `from` has `kPa` and `to` no unit; write both in one unit"},
      {"{ from = \"1 kPa\", to = \"1.0 kPa\", points = 3 }",
       "press.toml:5:49: `from` and `to` are the same; give `tissue.young_modulus` two ends, or "
       "one "
       "value outside of `[sweep]`"},
      {"{ from = \"skin\", to = \"bone\", points = 3 }",
       "press.toml:5:35: `from` wants a number or a quantity, got `skin`; write it as `from = \"1 "
       "kPa\"`, or give a list of values"},
      {"{ from = \"nan kPa\", to = \"1 kPa\", points = 3 }",
       "press.toml:5:35: `from` wants a finite number, got `nan kPa`; write one as `0.5`"},
      {"{ from = \"1 kPa\", to = inf, points = 3 }",
       "press.toml:5:49: `to` wants a finite number, got `inf`; write one as `0.5`"},
      {"{ from = \"1 kPa\", to = \"1e400 kPa\", points = 3 }",
       "press.toml:5:49: `to` wants a finite number, got `1e400 kPa`; write one as `0.5`"},
      {"{ from = \"1 kPa\", to = \"1.00000000001 kPa\", points = 9 }",
       "press.toml:5:79: `points` of `tissue.young_modulus` are closer than 12 digits can "
       "distinguish; take fewer, or a wider range"},
  };
  for (const auto& [range, sentence] : cases) {
    const std::string sweep = young + std::string(range) + "\n";
    EXPECT_EQ(said(sweep), sentence) << sweep;
  }
  EXPECT_EQ(
      said("design = \"lhs\"\nsamples = 5\n\"contact.friction\" = { from = 0, to = 1, points "
           "= 3 }\n"),
      "press.toml:7:22: `points` of `contact.friction` have no effect with `design = \"lhs\"`, "
      "where `samples` counts; remove them");
}

// The values between are within the limits, where the ends are not.
TEST(Refused, RangesThatLeaveAKeysLimits) {
  EXPECT_EQ(said("design = \"sobol\"\nsamples = 1\n\"tissue.poisson_ratio\" = { from = 0.1, to = "
                 "0.5 }\n"),
            "press.toml:7:45: `poisson_ratio` must be above -1 and below 0.5, got `0.5`; for a "
            "tissue that keeps its volume give 0.49, which lowers the force by 1.3 % on deep "
            "tissue and by more on a thin layer");
  EXPECT_EQ(said("design = \"lhs\"\nsamples = 1\n\"finger.radius\" = { from = \"0 mm\", to = \"11 "
                 "mm\" }\n"),
            "press.toml:7:28: `radius` must be at least 1e-06 mm and at most 1e+06 mm, got `0 mm`; "
            "give a value in that range");
  EXPECT_TRUE(said("\"tissue.young_modulus\" = { from = \"1 mm\", to = \"9 mm\", points = 3 }\n")
                  .starts_with("press.toml:5:35: `young_modulus` wants a pressure, got `1 mm`"));
  EXPECT_EQ(said("design = \"lhs\"\nsamples = 2\n\"finger.spheres\" = { from = 1, to = 7 }\n"),
            "press.toml:7:29: `finger.spheres` wants whole numbers, which a range does not keep "
            "to; give a list, as `[1, 2, 3]`");
  EXPECT_EQ(said("design = \"lhs\"\nsamples = 2\n\"tissue.material\" = [\"skin\", \"skim\"]\n"
                 "\"finger.radius\" = { from = \"8 mm\", to = \"9 mm\" }\n"),
            "press.toml:7:30: `material` does not know `skim`; did you mean `skin`? Known here: "
            "finger, skin, muscle, bone, ligament, upper_leg; your own tables are written "
            "`file.toml#name`");
}

TEST(Refused, WhatChangesTogetherInDifferentNumbers) {
  EXPECT_EQ(
      said("design = \"list\"\n\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n\"contact.friction\" "
           "= [0]\n"),
      "press.toml:7:1: `finger.radius` has 2 values and `contact.friction` 1, and they change "
      "together; give as many of each");
  EXPECT_EQ(
      said("[[sweep.rows]]\n\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n\"contact.friction\" "
           "= [0]\n"),
      "press.toml:7:1: `finger.radius` has 2 values and `contact.friction` 1, and they change "
      "together; give as many of each");
  EXPECT_EQ(said("design = \"lhs\"\nsamples = 3\n[[sweep.rows]]\n\"finger.radius\" = [\"8 mm\", "
                 "\"9 mm\"]\n\"contact.friction\" = { from = 0, to = 1 }\n"),
            "press.toml:9:1: `finger.radius` and `contact.friction` change together in `design = "
            "\"lhs\"`, where one has a range and the other a list; give both the same");
  EXPECT_EQ(
      said("rows = 3\n"),
      "press.toml:5:8: `rows` wants a list of tables, got an integer; write `[[sweep.rows]]`");
  EXPECT_EQ(said("[[sweep.rows]]\n"),
            "press.toml:5:1: `rows` wants tables of keys that change together, got an empty one; "
            "write `[[sweep.rows]]` and lists of one length");
  EXPECT_EQ(said("\"contact.friction\" = [0, 1]\n[[sweep.rows]]\n\"contact.friction\" = [0, 1]\n"),
            "press.toml:7:1: `contact.friction` is swept twice; keep one of the two");
  EXPECT_EQ(said("\"tissue.mesh.kind\" = [\"kuhn\"]\n\"tissue.mesh\" = [{ kind = \"kuhn\" }]\n"),
            "press.toml:6:1: `tissue.mesh` stands after `tissue.mesh.kind` and replaces it; put it "
            "first");
}

TEST(Refused, KeysThatChangeNothing) {
  const std::string hertz = small_press + "[solver]\nmodel = \"hertz\"\n";
  EXPECT_EQ(said("\"solver.rings\" = [2, 3]\n", hertz),
            "press.toml:7:1: `solver.rings` is swept and changes nothing: it is used only with "
            "`solver.model = \"mass_spring\"` or `\"coupled_springs\"`; take it out of `[sweep]` "
            "or change that");
  // A key inside a table that is left unread, and one among others.
  EXPECT_EQ(said("\"contact.friction\" = [0, 1]\n\"tissue.mesh.cells\" = [[2, 2, 2], [3, 3, 3]]\n",
                 hertz + "[tissue]\nmesh = { kind = \"kuhn\" }\n"),
            "press.toml:10:1: `tissue.mesh.cells` is swept and changes nothing: it is used only "
            "with `solver.model = \"mass_spring\"` or `\"coupled_springs\"`; take it out of "
            "`[sweep]` or change that");
  EXPECT_TRUE(said("\"solver.start\" = [\"consistent\", \"paper\"]\n",
                   small_press + "[solver]\nintegrator = \"quasi_static\"\n")
                  .starts_with("press.toml:7:1: `solver.start` is swept and changes nothing"));
  // One case that reads the key is enough, whichever it is.
  EXPECT_EQ(said("\"solver.model\" = [\"hertz\", \"mass_spring\"]\n\"solver.rings\" = [2, 3]\n"),
            "accepted");
  EXPECT_EQ(said("\"finger.calibration\" = [\"force\", \"mass\"]\n\"finger.spheres\" = [1, 8]\n"),
            "accepted");
}

// A sample's corners are none of its cases; a list's values meet those of their own row only.
TEST(Refused, OnlyWhatMeetsFailsTogether) {
  EXPECT_EQ(said("design = \"list\"\n\"finger.radius\" = [\"1 mm\", \"9 mm\"]\n\"step.1.to\" = "
                 "[\"0.5 mm\", \"5 mm\"]\n"),
            "accepted");
  EXPECT_EQ(
      said("design = \"list\"\n\"finger.radius\" = [\"9 mm\", \"1 mm\"]\n\"step.1.to\" = "
           "[\"0.5 mm\", \"5 mm\"]\n"),
      "press.toml:7:26: `to` of 5 mm is deeper than the finger's radius of 1 mm, and a "
      "sphere presses with its lower half; press less deep, or give a larger `finger.radius`");
  EXPECT_EQ(said("design = \"sobol\"\nsamples = 1\n\"finger.radius\" = { from = \"1 mm\", to = \"9 "
                 "mm\" }\n\"step.1.to\" = { from = \"0.1 mm\", to = \"6 mm\" }\n"),
            "accepted");
  EXPECT_TRUE(
      said("\"finger.radius\" = { from = \"1 mm\", to = \"9 mm\", points = 2 }\n\"step.1.to\""
           " = { from = \"0.1 mm\", to = \"6 mm\", points = 2 }\n")
          .starts_with("press.toml:6:39: `to` of 6 mm is deeper than the finger's radius"));
}

TEST(Refused, SettingsOfSweptKeys) {
  const auto set = [](const std::string& sweep) {
    return test::refusal([&] {
      return parse(small_press + "[sweep]\n" + sweep, "press.toml", {"finger.radius=8 mm"});
    });
  };
  EXPECT_EQ(set("finger.radius = { from = \"8 mm\", to = \"9 mm\", points = 2 }\n"),
            "--set finger.radius=8 mm: `finger.radius` is swept, so that one value has no effect; "
            "set the list, `sweep.finger.radius=[...]`");
  EXPECT_EQ(set("[[sweep.rows]]\n\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n"),
            "--set finger.radius=8 mm: `finger.radius` is swept, so that one value has no effect; "
            "change its values in `[sweep]`");
}

// Which model `auto` becomes is known once a case is looked at.
TEST(Refused, KeysThatTheChosenModelHasNoUseFor) {
  const Family family =
      outline_text(small_press +
                       "[solver]\nmodel = \"auto\"\n[sweep]\n\"solver.rings\" = [2, 3]\n"
                       "\"tissue.density\" = [\"1000 kg/m^3\"]\n\"contact.friction\" = [0]\n",
                   "press.toml", {});
  EXPECT_EQ(unread_keys(family, 1, Solver::Model::hertz),
            (std::vector<std::string>{"solver.rings", "tissue.density"}));
  EXPECT_EQ(unread_keys(family, 1, Solver::Model::mass_spring), std::vector<std::string>{});
}

TEST(Refused, ValuesThatMakeTheSameCase) {
  EXPECT_EQ(said("design = \"list\"\n\"finger.radius\" = [\"8 mm\", \"9 mm\", \"8.0 mm\"]\n"
                 "\"contact.friction\" = [0, 0, 0.0]\n"),
            "press.toml:6:36: `8 mm, 0` and `8.0 mm, 0.0` make the same case; keep one of them");
  EXPECT_EQ(said("\"finger.radius\" = [\"8 mm\", \"10 mm\", \"1 cm\"]\n"),
            "press.toml:5:37: `10 mm` and `1 cm` of `finger.radius` make the same case; keep one "
            "of them");
  EXPECT_EQ(said("[[sweep.rows]]\n\"finger.radius\" = [\"8 mm\", \"8 mm\"]\n\"contact.friction\" = "
                 "[0.0, 0]\n"),
            "press.toml:6:28: `8 mm, 0.0` and `8 mm, 0` of `finger.radius + contact.friction` make "
            "the same case; keep one of them");
  EXPECT_EQ(said("[[sweep.rows]]\n\"finger.radius\" = [\"8 mm\", \"8 mm\"]\n\"contact.friction\" = "
                 "[0.0, 1]\n"),
            "accepted");
}

// Rubbish in the place of a range ends in a sentence with a place, whatever it is.
RC_GTEST_PROP(Refused, RubbishHasAPlace, ()) {
  const auto some = [](const std::vector<std::string>& words) {
    return words[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(words.size())))];
  };
  const std::vector<std::string> values{"1",       "-1",         "\"1 kPa\"", "\"9 kPa\"", "\"\"",
                                        "[1]",     "[]",         "{}",        "nan",       "-inf",
                                        "\"kPa\"", "\"1 kPa²\"", "true",      "0x1F",      "1e308"};
  const std::vector<std::string> keys{"from", "to", "points", "scale", "form"};
  std::string text = "design = \"" + some(design_words()) + "\"\n";
  if (*rc::gen::arbitrary<bool>()) text += "samples = " + some(values) + "\n";
  text += young;
  if (*rc::gen::arbitrary<bool>())
    text += some(values) + "\n";
  else
    text += "{ from = " + some(values) + ", to = " + some(values) + ", " + some(keys) + " = " +
            some(values) + " }\n";
  const std::string answer =
      test::refusal([&] { return parse(small_press + "[sweep]\n" + text, "press.toml", {}); });
  RC_ASSERT(answer == "accepted" || answer.starts_with("press.toml:"));
}

}  // namespace
}  // namespace palpate::scenario
