// CSV there and back, and every message with its line.
#include "record/csv.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "refusal.h"

namespace palpate::record {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// The same bits, so that -0 is not 0; any NaN is NaN.
bool same(const Cell& a, const Cell& b) {
  const auto* x = std::get_if<double>(&a);
  const auto* y = std::get_if<double>(&b);
  if (x == nullptr || y == nullptr) return a == b;
  if (std::isnan(*x) || std::isnan(*y)) return std::isnan(*x) && std::isnan(*y);
  return std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
}

bool same(const Table& a, const Table& b) {
  if (a.columns != b.columns || a.rows.size() != b.rows.size()) return false;
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    if (a.rows[i].size() != b.rows[i].size()) return false;
    for (std::size_t k = 0; k < a.rows[i].size(); ++k)
      if (!same(a.rows[i][k], b.rows[i][k])) return false;
  }
  return true;
}

std::string refusal(std::string_view text) {
  return test::refusal([&] { return parse_csv(text, "data.csv"); });
}

TEST(Csv, WritesWhatTheManualSays) {
  Table table;
  table.columns = {"case", "force_N", "note"};
  table.rows = {{std::string("skin"), 0.1, std::monostate{}},
                {std::string("a,b"), -inf, std::string("he said \"no\"")},
                {std::string("7"), std::nan(""), std::string()}};
  EXPECT_EQ(csv_text(table),
            "case,force_N,note\nskin,0.1,\n\"a,b\",-inf,\"he said \"\"no\"\"\"\n\"7\",nan,\"\"\n");
  EXPECT_TRUE(same(parse_csv(csv_text(table), "t.csv"), table));
}

TEST(Csv, ReadsWhatOthersWrite) {
  const Table table =
      parse_csv("\xEF\xBB\xBF\"a\", b\r\n1 ,\"x\r\ny\"\r\n+2.5e-1,NaN\r\n\r\n", "t.csv");
  ASSERT_EQ(table.columns, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], Cell(1.0));
  EXPECT_EQ(table.rows[0][1], Cell(std::string("x\r\ny")));
  EXPECT_EQ(table.rows[1][0], Cell(0.25));
  EXPECT_TRUE(std::isnan(std::get<double>(table.rows[1][1])));
  EXPECT_EQ(parse_csv("a,b\n1,2", "t.csv").rows.size(), 1U);  // no line feed at the end
  EXPECT_EQ(parse_csv("a,b\n1,\n", "t.csv").rows[0][1], Cell(std::monostate{}));
}

TEST(Csv, OneColumnKeepsItsEmptyRows) {
  Table table{{"x"}, {{1.0}, {std::monostate{}}, {std::monostate{}}}};
  EXPECT_TRUE(same(parse_csv(csv_text(table), "t.csv"), table));
}

TEST(Csv, RefusesWithPlaceAndRemedy) {
  EXPECT_EQ(refusal(""), "data.csv:1: the file is empty; its first row names the columns");
  EXPECT_EQ(refusal(" \n\r\n"), "data.csv:1: the file is empty; its first row names the columns");
  EXPECT_EQ(refusal("a,b\n1,2\n3\n"),
            "data.csv:3: this row has 1 fields, the header names 2; give every row one field per "
            "column");
  EXPECT_EQ(refusal("a,b\n\"x\ny\",2\n1,2,3\n"),
            "data.csv:4: this row has 3 fields, the header names 2; give every row one field per "
            "column");
  EXPECT_EQ(refusal("a,b,a\n"), "data.csv:1: the column name `a` occurs twice; rename one");
  EXPECT_EQ(refusal("a,,b\n"),
            "data.csv:1: column 2 has no name; the first row names every column");
  EXPECT_EQ(refusal("a,b\n1,\"x\n2,3\n"),
            "data.csv:2: the quote opened on this line is not closed; end it with `\"`");
  EXPECT_EQ(refusal("a,b\n1,x\"y\n"),
            "data.csv:2: a quote stands inside the field `x\"y`; put quotes around the whole field "
            "and double those inside");
  EXPECT_EQ(refusal("a,b\n1,\"x\"y\n"),
            "data.csv:2: text follows a closing quote; put a comma between them, or double the "
            "quote");
  EXPECT_EQ(refusal("a;b\n1;2\n"),
            "data.csv:1: the columns are not separated by commas; save the table with commas");
  EXPECT_EQ(refusal("a,b\n1,1e400\n"),
            "data.csv:2: `1e400` is too large or too small; write a number between 1e-300 and "
            "1e300 in size");
}

TEST(Csv, MissingFileIsNamed) {
  EXPECT_THROW(static_cast<void>(read_csv("/nowhere/data.csv")), InputError);
}

// Words out of everything that a reader may stumble over.
std::string random_word() {
  return *rc::gen::container<std::string>(
      rc::gen::elementOf(std::string("ab1.e+-,;\"'\n\r\t _naif\xC3")));
}

Cell random_cell() {
  switch (*rc::gen::inRange(0, 4)) {
    case 0: return std::monostate{};
    case 1: return random_word();
    case 2:
      return *rc::gen::elementOf(
          std::vector<double>{0.0, -0.0, inf, -inf, std::nan(""), 5e-324, 1.7976931348623157e308});
    default: return std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  }
}

TEST(Csv, EveryTableComesBack) {
  EXPECT_TRUE(rc::check("parse(text(table)) == table", [] {
    Table table;
    const int width = *rc::gen::inRange(1, 5);
    for (int k = 0; k < width; ++k) table.columns.push_back(std::to_string(k) + random_word());
    const int height = *rc::gen::inRange(0, 6);
    for (int i = 0; i < height; ++i) {
      std::vector<Cell> row;
      for (int k = 0; k < width; ++k) row.push_back(random_cell());
      table.rows.push_back(row);
    }
    RC_ASSERT(same(parse_csv(csv_text(table), "t.csv"), table));
  }));
}

}  // namespace
}  // namespace palpate::record
