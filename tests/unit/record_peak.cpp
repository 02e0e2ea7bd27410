// What a case was run for.
#include "record/record.h"

#include <gtest/gtest.h>

namespace palpate::record {
namespace {

// What a test prescribes is no result of it.
TEST(Peak, IsOfWhatWasNotPrescribed) {
  CaseRecord record;
  EXPECT_FALSE(peak_of(record));
  record.strain = {{.stress = 300.0, .strain = 0.02}, {.stress = -500.0, .strain = 0.02}};
  record.findings = {{"peak_strain", 0.02}};
  EXPECT_EQ(peak_of(record)->of, "stress");
  EXPECT_EQ(peak_of(record)->value, 0.5);  // kPa
  record.findings.push_back({"elastic_strain", 0.02});
  EXPECT_EQ(peak_of(record)->of, "strain");
  record.findings.push_back({"peak_force_N", 3.0});
  EXPECT_EQ(peak_of(record)->of, "force");
}

TEST(ReachedText, IsTheDisplacementOfAPressAndTheTimeOfOtherMotions) {
  CaseRecord record;
  record.contact = {{.travel = 0.0}};
  EXPECT_EQ(reached_text(record), "");  // the row before the press
  record.contact.push_back({.travel = 3.6e-3});
  record.last_stable_time = 0.72;
  EXPECT_EQ(reached_text(record), "up to a displacement of 3.6 mm");
  record.contact.push_back({.travel = 3.6e-3});
  EXPECT_EQ(reached_text(record), "up to a time of 0.72 s");
}

}  // namespace
}  // namespace palpate::record
