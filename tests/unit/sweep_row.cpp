// A row of a sweep is read back to the bit from its columns' names, or not at all.
#include "sweep/row.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace palpate::sweep {
namespace {

SweepRow example() {
  SweepRow row{.id = 0x0123456789abcdef,
               .attempt = 3,
               .outcome = SweepOutcome::diverged,
               .reason = "a\ttab, a \"quote\", a back\\slash\nand a line",
               .name = "20 kPa_0.3"};
  row.values = {{"force_N", 0.1 + 0.2},
                {"smallest", std::numeric_limits<double>::denorm_min()},
                {"greatest", std::numeric_limits<double>::max()},
                {"zero", -0.0},
                {"unknown", std::numeric_limits<double>::quiet_NaN()},
                {"endless", -std::numeric_limits<double>::infinity()},
                {"nothing", std::monostate{}},
                {"empty", std::string()},
                {"model", std::string("nan")}};
  row.neglected = {{"viscosity", 0.1 + 0.2, "which \\t is no tab", "add `a`", "viscosity"},
                   {.what = "an edge", .when = "which is \"near\""}};
  row.curve = {{"time_s", "force_N"}, {{0.0, 1.0}, {0.1, std::monostate{}}, {0.2, -1e-300}}};
  return row;
}

// As a journal would give it back.
record::Table through_a_line(const record::Table& row) {
  std::string line = record::sealed_line(row, "plan");
  line.pop_back();
  const auto back = record::read_line(line, "plan");
  EXPECT_TRUE(back) << line;
  return back.value_or(record::Table());
}

void expect_same(const record::Cell& a, const record::Cell& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const auto* number = std::get_if<double>(&a))
    EXPECT_EQ(
        std::isnan(*number) ? 0 : std::bit_cast<std::uint64_t>(*number),
        std::isnan(std::get<double>(b)) ? 0 : std::bit_cast<std::uint64_t>(std::get<double>(b)));
  else
    EXPECT_EQ(a, b);
}

TEST(SweepRow, is_read_back_to_the_bit) {
  const SweepRow row = example();
  const auto back = row_of(through_a_line(journal_row(row)));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id, row.id);
  EXPECT_EQ(back->attempt, 3U);
  EXPECT_EQ(back->outcome, SweepOutcome::diverged);
  EXPECT_EQ(back->reason, row.reason);
  EXPECT_EQ(back->name, row.name);
  ASSERT_EQ(back->neglected.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back->neglected[i].sentence(), row.neglected[i].sentence());
    EXPECT_EQ(back->neglected[i].change, row.neglected[i].change);
    EXPECT_EQ(back->neglected[i].beside, row.neglected[i].beside);
  }
  ASSERT_EQ(back->values.size(), row.values.size());
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    EXPECT_EQ(back->values[i].name, row.values[i].name);
    expect_same(back->values[i].value, row.values[i].value);
  }
  EXPECT_EQ(back->curve.columns, row.curve.columns);
  ASSERT_EQ(back->curve.rows.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) expect_same(back->curve.rows[i][k], row.curve.rows[i][k]);
}

TEST(SweepRow, one_without_anything_is_read_back) {
  const auto back = row_of(through_a_line(journal_row({.id = 7})));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id, 7U);
  EXPECT_TRUE(back->values.empty());
  EXPECT_TRUE(back->neglected.empty());
  EXPECT_TRUE(back->curve.columns.empty());
}

TEST(SweepRow, one_with_cells_of_another_kind_is_none) {
  const auto with = [](const char* column, record::Cell cell) {
    record::Table row = journal_row(example());
    row.rows.front()[static_cast<std::size_t>(row.find(column))] = std::move(cell);
    return row;
  };
  EXPECT_TRUE(row_of(with("name", std::string("other"))));
  for (const double attempt : {0.0, -1.0, 1e300, std::nan("")})
    EXPECT_FALSE(row_of(with("attempt", attempt))) << attempt;
  for (const char* text : {"name,value\n1,2\n", "name\nx\n", "name,value\nx\n", ""})
    EXPECT_FALSE(row_of(with("values", std::string(text)))) << text;
  for (const char* text : {"what\nx\n", "what,change,when,remedy,beside\n1,2,a,b,c\n", ""})
    EXPECT_FALSE(row_of(with("neglected", std::string(text)))) << text;
  EXPECT_FALSE(row_of(with("curve", std::string("a,a\n1,2\n"))));
}

TEST(SweepRow, its_head_is_read_alone) {
  const auto head = head_of(journal_row(example()));
  ASSERT_TRUE(head);
  EXPECT_EQ(head->id, 0x0123456789abcdefU);
  EXPECT_EQ(head->attempt, 3U);
  EXPECT_EQ(head->outcome, SweepOutcome::diverged);
}

// A later version may add columns and write them in another order.
TEST(SweepRow, columns_count_by_their_names) {
  record::Table row = journal_row(example());
  row.columns.insert(row.columns.begin(), "seconds");
  row.rows[0].insert(row.rows[0].begin(), 1.5);
  std::reverse(row.columns.begin(), row.columns.end());
  std::reverse(row.rows[0].begin(), row.rows[0].end());
  const auto back = row_of(through_a_line(row));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id, example().id);
  EXPECT_EQ(back->name, example().name);
  EXPECT_EQ(back->values.size(), example().values.size());
}

TEST(SweepRow, one_without_a_column_is_none) {
  const record::Table whole = journal_row(example());
  for (std::size_t i = 0; i < whole.columns.size(); ++i) {
    record::Table row = whole;
    row.columns.erase(row.columns.begin() + static_cast<long>(i));
    row.rows[0].erase(row.rows[0].begin() + static_cast<long>(i));
    EXPECT_FALSE(head_of(row)) << whole.columns[i];
    EXPECT_FALSE(row_of(row)) << whole.columns[i];
  }
}

TEST(SweepRow, one_that_says_what_it_cannot_is_none) {
  const auto with = [](const char* column, record::Cell cell) {
    record::Table row = journal_row(example());
    row.rows[0][static_cast<std::size_t>(row.find(column))] = std::move(cell);
    return row_of(row).has_value();
  };
  EXPECT_TRUE(with("outcome", "completed"));
  EXPECT_FALSE(with("outcome", "finished"));
  EXPECT_FALSE(with("id", "255"));
  EXPECT_FALSE(with("attempt", "3"));
  EXPECT_FALSE(with("reason", 3.0));
}

TEST(SweepRow, ids_are_sixteen_digits) {
  EXPECT_EQ(id_text(0x00ff00000000000aU), "00ff00000000000a");
  EXPECT_EQ(id_of("00ff00000000000a"), 0x00ff00000000000aU);
  for (const char* wrong : {"", "ff", "00ff00000000000g", "+0ff00000000000a", "00ff00000000000a0"})
    EXPECT_FALSE(id_of(wrong)) << wrong;
}

}  // namespace
}  // namespace palpate::sweep
