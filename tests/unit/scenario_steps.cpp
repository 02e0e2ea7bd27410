// Steps that follow each other, and times that fit each other.
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

std::string step(const std::string& kind, const std::string& to) {
  return "[[step]]\nkind = \"" + kind + "\"\nto = \"" + to + "\"\n";
}

TEST(Steps, GoOnFromWhereTheLastOneEnded) {
  EXPECT_EQ(refusal(step("indent", "2 mm") + step("indent", "3 mm") + step("retract", "1 mm") +
                    step("indent", "2 mm") + step("retract", "-1 mm")),
            "accepted");
  EXPECT_EQ(refusal(step("indent", "2 mm") + step("indent", "2 mm")),
            "press.toml:6:6: `indent` goes to 2 mm, which is not below the displacement of 2 mm "
            "before it; "
            "use `retract` to go back");
  EXPECT_EQ(
      refusal(step("indent", "2 mm") + step("retract", "3 mm")),
      "press.toml:6:6: `retract` goes to 3 mm, which is not above the displacement of 2 mm before "
      "it; use `indent` to go deeper");
  EXPECT_EQ(
      refusal(step("retract", "0 mm")),
      "press.toml:3:6: `retract` goes to 0 mm, which is not above the displacement of 0 mm before "
      "it; use `indent` to go deeper");
}

TEST(Steps, PressAtLeastOnce) {
  const std::string hold = "[[step]]\nkind = \"hold\"\ntime = \"1 s\"\n";
  const std::string sentence =
      "press.toml:1:1: no `step` presses the finger into the tissue; begin with `kind = "
      "\"indent\"`";
  EXPECT_EQ(refusal(hold), sentence);
  EXPECT_EQ(refusal(hold + step("retract", "-1 mm")), sentence);
  EXPECT_EQ(refusal(hold + step("indent", "1 mm")), "accepted");
}

TEST(Steps, AStepToAForceLeavesTheTravelOpen) {
  EXPECT_EQ(refusal(step("indent", "1 N") + step("indent", "2 N") + step("retract", "0 mm")),
            "accepted");
  EXPECT_EQ(
      refusal(step("indent", "2 N") + step("indent", "1 N")),
      "press.toml:6:6: `indent` goes to 1 N, which is not above the force of 2 N before it; use "
      "`retract` to go back");
  EXPECT_EQ(refusal(step("indent", "2 N") + step("indent", "5 mm")),
            "press.toml:6:6: `indent` goes to 5 mm after a step to a force, which may have gone "
            "deeper; give a force here too, or `retract` first");
}

TEST(Steps, StayInsideTheSpecimen) {
  EXPECT_EQ(
      refusal(step("indent", "12 mm")),
      "press.toml:3:6: `to` of 12 mm is deeper than the finger's radius of 11 mm, and a "
      "sphere presses with its lower half; press less deep, or give a larger `finger.radius`");
  EXPECT_EQ(refusal(step("indent", "4 mm") +
                    "[tissue]\nshape = { size = [\"60 mm\", \"60 mm\", \"4 mm\"] }\n"),
            "press.toml:3:6: `to` of 4 mm presses through the specimen, which is 4 mm high; press "
            "less deep");
  EXPECT_EQ(
      refusal(step("indent", "4 mm") +
              "[tissue]\nshape = { size = [\"60 mm\", \"10 mm\", \"30 mm\"] }\n"),
      "press.toml:3:6: `to` of 4 mm makes a contact wider than the specimen's top; press less "
      "deep or use a wider specimen");
}

TEST(Steps, OfBothKindsAreTwoScenarios) {
  const std::string sentence =
      "`creep`, `relax` and `compress` load the end faces without a finger, the other kinds of "
      "`step` have one; put them into two scenarios";
  EXPECT_EQ(refusal(step("indent", "2 mm") + "[[step]]\nkind = \"creep\"\n[finger]\nradius = \"9 "
                                             "mm\"\n"),
            "press.toml:4:1: " + sentence);
  EXPECT_EQ(refusal("[[step]]\nkind = \"relax\"\n[[step]]\nkind = \"hold\"\n"),
            "press.toml:3:1: " + sentence);
}

TEST(Steps, OfACompressionHaveOneLawOfTimeAndOnePlaten) {
  const std::string compress = "[[step]]\nkind = \"compress\"\n";
  const std::string more = "[tissue]\nviscosity = \"";
  EXPECT_EQ(refusal(compress + "[solver]\nintegrator = \"quasi_static\"\n"), "accepted");
  EXPECT_EQ(refusal(compress + compress), "accepted");
  expect_refused(
      {{"[solver]\nintegrator = \"modal\"\n",
        "press.toml:2:8: `compress` is computed without inertia; leave `solver.integrator` out"},
       {"[solver]\nkinematics = \"nonlinear\"\n",
        "press.toml:2:8: `compress` is computed for small strain; leave `solver.kinematics` out"},
       {more + "nodal_drag\"\n",
        "press.toml:2:8: `compress` is computed without nodal drag; write another "
        "`tissue.viscosity`"},
       {compress + "platen = \"bonded\"\n",
        "press.toml:4:8: all steps of a scenario have one upper platen; put steps with another "
        "`platen` into another scenario"}},
      compress);
  EXPECT_EQ(refusal(compress + "platen = \"bonded\"\n[[step]]\nkind = \"relax\"\n"),
            "press.toml:2:8: all steps of a scenario have one upper platen; put steps with another "
            "`platen` into another scenario");
}

TEST(Steps, TimesFitEachOther) {
  const auto times = [](const std::string& time_step) {
    return refusal(step("indent", "2 mm") +
                   "[output]\ninterval = \"1 ms\"\n[solver]\ntime_step = \"" + time_step + "\"\n");
  };
  for (const char* fits : {"auto", "1 ms", "0.5 ms", "0.1 ms", "0.001 ms", "1e-6 s"})
    EXPECT_EQ(times(fits), "accepted") << fits;
  const std::string remedy =
      ", which does not fit a whole number of times into `output.interval` of 1 ms; write "
      "`time_step = \"auto\"` or a whole part of the interval";
  EXPECT_EQ(times("0.3 ms"), "press.toml:7:13: `time_step` is 0.3 ms" + remedy);
  EXPECT_EQ(times("2 ms"), "press.toml:7:13: `time_step` is 2 ms" + remedy);
  EXPECT_EQ(times("1.4 ms"), "press.toml:7:13: `time_step` is 1.4 ms" + remedy);
  EXPECT_EQ(times("1e-300 s"),
            "press.toml:7:13: `time_step` is 1e-297 ms, more than a million times shorter than "
            "`output.interval`; choose a longer one");
}

TEST(Steps, MoreRowsThanAMillionAreRefused) {
  EXPECT_EQ(refusal(step("indent", "2 mm") +
                    "[[step]]\nkind = \"hold\"\ntime = \"1e9 s\"\n[output]\ninterval = \"1 s\"\n"),
            "press.toml:8:12: `output.interval` of 1000 ms would write 1e+09 rows a case, and a "
            "million is the most; use a longer one");
}

}  // namespace
}  // namespace palpate::scenario
