// The rule of equality, cell by cell; the text for people; the tolerances' messages.
#include "compare/compare.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"

namespace palpate::compare {
namespace {

using record::Cell;
using record::Table;

constexpr double inf = std::numeric_limits<double>::infinity();
const Cell nothing = std::monostate{};

Table column(const std::vector<Cell>& cells) {
  Table table{{"x"}, {}};
  for (const Cell& cell : cells) table.rows.push_back({cell});
  return table;
}

bool equal(const Cell& got, const Cell& want, const Tolerance& tolerance = {}) {
  return compare(column({got}), column({want}), {.standard = tolerance}).equal();
}

TEST(Compare, NumbersWithinTheTolerance) {
  EXPECT_TRUE(equal(1.0, 1.0, {.rel = 0, .abs = 0}));
  EXPECT_FALSE(equal(std::nextafter(1.0, 2.0), 1.0, {.rel = 0, .abs = 0}));
  EXPECT_TRUE(equal(1.125, 1.0, {.rel = 0.125, .abs = 0}));  // the bound itself is within
  EXPECT_FALSE(equal(1.1250001, 1.0, {.rel = 0.125, .abs = 0}));
  EXPECT_TRUE(equal(-9.0, -8.0, {.rel = 0.0625, .abs = 0.5}));  // both parts add up
  EXPECT_FALSE(equal(1e-12, 0.0, {.rel = 1.0, .abs = 0}));      // rel is of the wanted
  EXPECT_TRUE(equal(0.0, 1e-12, {.rel = 1.0, .abs = 0}));
  EXPECT_TRUE(equal(-0.0, 0.0, {.rel = 0, .abs = 0}));
}

TEST(Compare, WhatIsNoFiniteNumberIsTheSameOrDiffers) {
  const double nan = std::nan("");
  EXPECT_TRUE(equal(nan, nan));
  EXPECT_TRUE(equal(inf, inf));
  EXPECT_FALSE(equal(inf, -inf));
  EXPECT_FALSE(equal(1.0, inf, {.rel = 1}));  // rel * inf allows nothing
  EXPECT_FALSE(equal(inf, 1.0, {.rel = 1}));
  EXPECT_FALSE(equal(nan, 1.0));
  EXPECT_FALSE(equal(1.0, nan));
  EXPECT_TRUE(equal(nothing, nothing));
  EXPECT_FALSE(equal(nothing, 0.0, {.rel = 1, .abs = 1}));
  EXPECT_FALSE(equal(nothing, std::string()));
  EXPECT_TRUE(equal(std::string("skin"), std::string("skin")));
  EXPECT_FALSE(equal(std::string("skin"), std::string("Skin")));
  EXPECT_FALSE(equal(std::string("1"), 1.0));
}

TEST(Compare, NamesTheWorstRow) {
  const Table want{{"case", "force_N"},
                   {{std::string("a"), 1.0}, {std::string("b"), 2.0}, {std::string("c"), 4.0}}};
  Table got = want;
  got.rows[1][1] = 2.5;
  got.rows[2][1] = 4.5;
  const Comparison result = compare(got, want, {.standard = {.rel = 0.0625}});
  EXPECT_FALSE(result.equal());
  EXPECT_EQ(result.columns[1].differing, 2U);
  EXPECT_EQ(result.columns[1].worst->row, 2U);
  EXPECT_EQ(result.columns[1].worst->relative, 0.25);
  EXPECT_EQ(result.columns[1].worst->allowed, 0.125);
  EXPECT_EQ(verdict_text(result.columns[1]),
            "DIFFERS in 2 rows; worst row 2: case `b`, got 2.5, want 2, relative difference 0.25, "
            "allowed 0.125");
  const Comparison wide = compare(got, want, {.standard = {.rel = 0.5}});
  EXPECT_TRUE(wide.equal());
  EXPECT_EQ(verdict_text(wide.columns[1]),
            "equal; worst row 2: case `b`, got 2.5, want 2, relative difference 0.25, allowed 1");
}

// As many digits as show the difference to three of its own, and no more.
TEST(Compare, PrintsTheDigitsThatDiffer) {
  const Table want{{"force_N"}, {{1.0 / 3.0}}};
  Table got = want;
  got.rows[0][0] = (1.0 + 1.25e-6) / 3.0;
  EXPECT_EQ(verdict_text(compare(got, want, {}).columns[0]).substr(0, 65),
            "DIFFERS in 1 row; worst row 1: got 0.33333375, want 0.333333333, ");
}

TEST(Compare, ColumnsByNameAndRowsByNumber) {
  const Table want{{"a", "b"}, {{1.0, 2.0}, {3.0, 4.0}}};
  EXPECT_TRUE(compare({{"b", "a"}, {{2.0, 1.0}, {4.0, 3.0}}}, want, {}).equal());
  const Comparison other = compare({{"a", "c"}, {{1.0, 2.0}}}, want, {});
  EXPECT_FALSE(other.rows_equal());
  EXPECT_EQ(verdict_text(other.columns[1]), "DIFFERS, the column is missing");
  EXPECT_EQ(verdict_text(other.columns[2]), "DIFFERS, the column is not wanted");
  Tolerances some;
  some.columns["b"].ignore = true;
  some.columns["c"].ignore = true;
  EXPECT_TRUE(compare({{"a", "c"}, {{1.0, 2.0}, {3.0, 4.0}}}, want, some).equal());
  EXPECT_FALSE(compare({{"a", "b"}, {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}}}, want, {}).equal());
}

Cell random_cell() {
  switch (*rc::gen::inRange(0, 3)) {
    case 0: return nothing;
    case 1: return *rc::gen::arbitrary<std::string>();
    default: return std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  }
}

Table random_table() {
  Table table;
  const int width = *rc::gen::inRange(1, 4);
  for (int k = 0; k < width; ++k) table.columns.push_back("c" + std::to_string(k));
  const int height = *rc::gen::inRange(1, 8);
  for (int i = 0; i < height; ++i) {
    table.rows.emplace_back();
    for (int k = 0; k < width; ++k) table.rows.back().push_back(random_cell());
  }
  return table;
}

TEST(Compare, EveryTableEqualsItself) {
  EXPECT_TRUE(rc::check("compare(x, x) is equal at no tolerance", [] {
    const Table table = random_table();
    RC_ASSERT(compare(table, table, {.standard = {.rel = 0, .abs = 0}}).equal());
  }));
}

TEST(Compare, OneChangedCellIsFound) {
  EXPECT_TRUE(rc::check("one changed cell differs, in its row", [] {
    const Table table = random_table();
    Table changed = table;
    const auto i = *rc::gen::inRange<std::size_t>(0, table.rows.size());
    const auto k = *rc::gen::inRange<std::size_t>(0, table.columns.size());
    Cell& cell = changed.rows[i][k];
    if (auto* number = std::get_if<double>(&cell)) {
      RC_PRE(std::isfinite(*number));
      *number = std::nextafter(*number, inf);
    } else {
      cell = std::holds_alternative<std::monostate>(cell) ? Cell(0.0) : nothing;
    }
    const Comparison result = compare(changed, table, {.standard = {.rel = 0, .abs = 0}});
    RC_ASSERT(!result.equal());
    RC_ASSERT(result.columns[k].differing == 1U);
    RC_ASSERT(result.columns[k].worst->row == i + 1);
  }));
}

}  // namespace
}  // namespace palpate::compare
