// What the rows of a sweep say together.
#include "sweep/merge.h"

#include <gtest/gtest.h>

namespace palpate::sweep {
namespace {

using Effects = std::vector<record::Neglected>;

SweepRow row(const char* model, std::optional<double> error, const Effects& neglected = {}) {
  SweepRow made{.values = {{"model", std::string(model)}}, .neglected = neglected};
  if (error) made.values.push_back({"stated_error", *error});
  return made;
}

using Lines = std::vector<std::string>;

TEST(SweepAnswers, TellModelsErrorsAndTheLargestOfEachEffect) {
  SweepAnswer answer;
  answer.see(row("hertz", 0.012,
                 {{"viscosity", -0.095, "which would take 9.5 % off the force", "add `a`"}}),
             1);
  answer.see(row("solid", 0.034,
                 {{"viscosity", 0.75, "which would add 75 % to the force", "add `b`"},
                  {"an edge", 0.12, "which may change it by up to 12 %"}}),
             2);
  answer.see(row("solid", 0.02), 3);
  EXPECT_EQ(answer.error(), "± 1.2 % to 3.4 %");
  answer.tolerance = "5 %";
  EXPECT_EQ(answer.error(), "± 1.2 % to 3.4 % (tolerance 5 %)");
  EXPECT_EQ(answer.lines(),
            (Lines{"Model: hertz in 1 of 3 cases, solid in 2 of 3 cases.",
                   "Neglected in 2 of 3 cases, most in case 2: viscosity, which would add 75 % to "
                   "the force; add `b`.",
                   "Neglected in 1 of 3 cases: an edge, which may change it by up to 12 %."}));
}

TEST(SweepAnswers, TellWhatTheirErrorsDoNotCount) {
  SweepAnswer answer;
  const Effects viscous{{.what = "viscosity", .change = 0.1, .beside = "viscosity"}};
  answer.see(row("hertz", 0.012, viscous), 1);
  EXPECT_EQ(answer.error(), "± 1.2 %, not counting viscosity");
  answer.see(row("hertz", 0.012), 2);
  EXPECT_EQ(answer.error(), "± 1.2 %, not counting viscosity in 1 of 2 cases");
}

TEST(SweepAnswers, SayWhereNothingIsNeglectedOrKnown) {
  SweepAnswer answer;
  EXPECT_EQ(answer.error(), "");
  EXPECT_EQ(answer.lines(), Lines{});
  SweepRow failed = row("hertz", 0.5, {{"all of it", 0.99, "which is 99 %"}});
  failed.outcome = SweepOutcome::failed;
  answer.see(failed, 1);
  EXPECT_EQ(answer.lines(), Lines{}) << "a case that failed has no say";
  answer.see(row("hertz", std::nullopt), 2);
  EXPECT_EQ(answer.error(), "error not known");
  answer.see(row("hertz", 0.03), 3);
  EXPECT_EQ(answer.error(), "± 3 %, not known in 1 of 2 cases");
  answer.see(row("hertz", 4.2), 4);
  EXPECT_EQ(answer.error(), "± 3 % to more than 100 %, not known in 1 of 3 cases");
  EXPECT_EQ(answer.lines().back(),
            "Neglected: nothing that would add more than a fifth of `solver.tolerance` to the "
            "error.");
}

}  // namespace
}  // namespace palpate::sweep
