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

TEST(AnswerLines, OneErrorIsSaidOnce) {
  EXPECT_EQ(peaks(0.012, 0.012),
            "Peak force: 0.1 N (`a`) to 0.2 N (`b`), with errors of about 1.2 %.");
}

}  // namespace
}  // namespace palpate::report
