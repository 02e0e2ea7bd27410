// Tolerance files: what a column inherits, and every message with its place.
#include "compare/compare.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "refusal.h"

namespace palpate::compare {
namespace {

std::string refusal(const std::string& text) {
  return test::refusal([&] { return parse_tolerances(text, "t.toml"); });
}

TEST(Tolerances, ColumnsInheritTheDefault) {
  const Tolerances some = parse_tolerances(
      "[column.force_N]\nabs = 0.25\nreason = \"thermal drift\"\n"
      "[column.wall_s]\nignore = true\n[default]\nrel = 1\n",
      "t.toml");
  EXPECT_EQ(some.standard.rel, 1.0);
  EXPECT_EQ(some.standard.abs, 0.0);
  EXPECT_EQ(some.of("force_N").rel, 1.0);
  EXPECT_EQ(some.of("force_N").abs, 0.25);
  EXPECT_EQ(some.of("force_N").reason, "thermal drift");
  EXPECT_TRUE(some.of("wall_s").ignore);
  EXPECT_FALSE(some.of("other").ignore);
  EXPECT_EQ(some.of("other").rel, 1.0);
}

TEST(Tolerances, RefuseWithPlaceAndRemedy) {
  EXPECT_EQ(refusal("[default]\nrell = 1e-9\n"),
            "t.toml:2:1: `rell` is not a key here; did you mean `rel`?");
  EXPECT_EQ(refusal("[columns.force_N]\nrel = 1\n"),
            "t.toml:1:2: `columns` is not a key here; did you mean `column`?");
  EXPECT_EQ(refusal("[pipe]\nx_abs = 1\n"),
            "t.toml:1:2: `pipe` is not a key here; known keys: column, default, tube");
  EXPECT_EQ(refusal("[column.force_N]\nrel = -1\nabs = \"1 N\"\nignore = 1\nreason = 2\n"),
            "t.toml:2:7: `rel` must be at least 0, got `-1`; give a value in that range\n"
            "t.toml:3:7: `abs` wants a pure number, got a text `1 N`; write it as `abs = 0.5`\n"
            "t.toml:4:10: `ignore` wants `true` or `false`, got an integer `1`; write it as "
            "`ignore = true`\n"
            "t.toml:5:10: `reason` wants a text, got an integer `2`; write it as `reason = \"2\"`");
  EXPECT_EQ(refusal("[default]\nrel = inf\n"),
            "t.toml:2:7: `rel` wants a finite number, got `inf`; write one as `0.5`");
  EXPECT_EQ(
      refusal("column = 3\n"),
      "t.toml:1:10: `column` wants a table, got an integer `3`; write it as `column = { ... }`");
  EXPECT_EQ(
      refusal("[column]\nforce_N = 3\n"),
      "t.toml:2:11: `force_N` wants a table, got an integer `3`; write it as `force_N = { ... }`");
}

}  // namespace
}  // namespace palpate::compare
