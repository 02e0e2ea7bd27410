// Tables for a person's eyes.
#include "cli/table_text.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palpate::cli
