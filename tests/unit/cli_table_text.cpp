// Tables for a person's eyes.
#include "cli/table_text.h"

#include <gtest/gtest.h>

#include "cli/talk.h"

namespace palpate::cli {
namespace {

TEST(TableText, ColumnsAreAlignedAndNumbersShort) {
  const record::Table table{
      {"model", "nodes", "error"},
      {{std::string("hertz"), record::Cell(), 0.0123456789}, {std::string("µ"), 123456.0, 12.0}}};
  EXPECT_EQ(aligned(table),
            "model   nodes    error\n"
            "hertz       -  0.01235\n"
            "µ      123456       12\n");
}

TEST(TableText, OneRowStandsUpright) {
  const record::Table turned = names_and_values({{"a", "b"}, {{1.0, std::string("x")}}});
  EXPECT_EQ(aligned(turned), "name  value\na         1\nb         x\n");
}

TEST(ProgressText, HasABarAndTheTimeLeft) {
  EXPECT_EQ(bar(5, 10), "[##########..........] 5/10");
  EXPECT_EQ(bar(5, 20, 10.0), "[#####...............] 5/20, 30 s left");
  EXPECT_EQ(bar(0, 20, 10.0), "[....................] 0/20") << "nothing is known yet";
  EXPECT_EQ(bar(0, 0), "[....................] 0/0");
  EXPECT_EQ(bar(1, 100, 60.0), "[....................] 1/100, 99 min left");
  EXPECT_EQ(progress_text("press", {}, 7.9), "press, 7 s");
  EXPECT_EQ(progress_text("press", {"fit", 1, 4}, 12.0),
            "[#####...............] 1/4, 36 s left, press, fit, 12 s");
}

}  // namespace
}  // namespace palpate::cli
