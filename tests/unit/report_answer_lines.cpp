// What is said of several cases together.
#include "report/answer_lines.h"

#include <gtest/gtest.h>

namespace palpate::report {
namespace {

record::CaseRecord one(const char* name, double force, double stated_error) {
  record::CaseRecord record;
  record.name = name;
  record.findings = {{"model", std::string("layer")}, {"peak_force_N", force}};
  record.answer.stated_error = stated_error;
  return record;
}

std::string peaks(double low, double high) {
  return answer_lines({one("a", 0.1, low), one("b", 0.2, high)}).at(1);
}

TEST(AnswerLines, ErrorsAboveTheWholeHaveNoDigits) {
  const std::string force = "Peak force: 0.1 N (`a`) to 0.2 N (`b`), with errors of ";
  EXPECT_EQ(peaks(0.012, 0.034), force + "about 1.2 % to 3.4 %.");
  EXPECT_EQ(peaks(0.012, 6.34), force + "about 1.2 % to more than 100 %.");
}

// As a single case does: the tolerance, of the case with the largest error, and what is not
// counted.
TEST(AnswerLines, ErrorsAreHeldAgainstTheTolerance) {
  record::CaseRecord least = one("a", 0.1, 0.012), most = one("b", 0.2, 0.061);
  least.answer.tolerance = "tolerance 5 %";
  most.answer.tolerance = "tolerance 5 %, and no model comes nearer";
  most.answer.uncounted = "viscosity";
  const std::string text =
      "Peak force: 0.1 N (`a`) to 0.2 N (`b`), with errors of about 1.2 % to 6.1 % (tolerance 5 %, "
      "and no model comes nearer), not counting viscosity";
  EXPECT_EQ(answer_lines({least, most}).at(1), text + " in 1 of 2 cases.");
  least.answer.uncounted = "viscosity";
  EXPECT_EQ(answer_lines({least, most}).at(1), text + ".");
}

// What a diverged case reached is no result, and does not set the range.
TEST(AnswerLines, DivergedCasesHaveNoForce) {
  record::CaseRecord wild = one("wild", 900.0, 0.0);
  wild.answer.stated_error.reset();
  wild.unstable = true;
  EXPECT_EQ(answer_lines({one("a", 0.1, 0.012), wild}).at(1),
            "1 of 2 cases diverged; peak force: 0.1 N (`a`) to 0.1 N (`a`), with errors of about "
            "1.2 %.");
  EXPECT_EQ(answer_lines({wild, wild}).at(1), "2 of 2 cases diverged.");
}

TEST(AnswerLines, OneErrorIsSaidOnce) {
  EXPECT_EQ(peaks(0.012, 0.012),
            "Peak force: 0.1 N (`a`) to 0.2 N (`b`), with errors of about 1.2 %.");
}

}  // namespace
}  // namespace palpate::report
