// What the rows of a sweep say together.
#include "sweep/merge.h"

#include <gtest/gtest.h>

namespace palpate::sweep {
namespace {

SweepRow row(const char* model, std::optional<double> error, const std::string& neglected = "") {
  SweepRow made{.values = {{"model", std::string(model)}}};
  if (error) made.values.push_back({"stated_error", *error});
  if (!neglected.empty()) made.warnings = {"the finger is too fast", "Neglected: " + neglected};
  return made;
}

using Lines = std::vector<std::string>;

TEST(SweepAnswers, TellModelsErrorsAndTheLargestOfEachEffect) {
  SweepAnswer answer;
  answer.see(row("hertz", 0.012, "viscosity, which would add 9.5 % to the force; add `a`."), 1);
  answer.see(row("solid", 0.034,
                 "viscosity, which would add 75 % to the force; add `a`. Also neglected: an edge, "
                 "which may change it by up to 12 %."),
             2);
  answer.see(row("solid", 0.02), 3);
  EXPECT_EQ(answer.error(), "± 1.2 % to 3.4 %");
  answer.tolerance = "5 %";
  EXPECT_EQ(answer.error(), "± 1.2 % to 3.4 % (tolerance 5 %)");
  EXPECT_EQ(answer.lines(),
            (Lines{"Model: hertz in 1 of 3 cases, solid in 2 of 3 cases.",
                   "Neglected in 2 of 3 cases, most in case 2: viscosity, which would add 75 % to "
                   "the force; add `a`.",
                   "Neglected in 1 of 3 cases: an edge, which may change it by up to 12 %."}));
}

TEST(SweepAnswers, TellWhatTheirErrorsDoNotCount) {
  SweepAnswer answer;
  SweepRow viscous = row("hertz", 0.012);
  viscous.warnings.emplace_back("not counting viscosity");
  answer.see(viscous, 1);
  EXPECT_EQ(answer.error(), "± 1.2 %, not counting viscosity");
  answer.see(row("hertz", 0.012), 2);
  EXPECT_EQ(answer.error(), "± 1.2 %, not counting viscosity in 1 of 2 cases");
}

TEST(SweepAnswers, SayWhereNothingIsNeglectedOrKnown) {
  SweepAnswer answer;
  EXPECT_EQ(answer.error(), "");
  EXPECT_EQ(answer.lines(), Lines{});
  SweepRow failed = row("hertz", 0.5, "all of it, 99 %.");
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
