// A row is read back to the bit, or not at all.
#include "study/sweep_row.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace palpate::study {
namespace {

const std::string plan(64, 'a');

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
  row.remarks = {"Deep.", "", "\\t is no tab"};
  row.curve = {{"time_s", "force_N"}, {{0.0, 1.0}, {0.1, std::monostate{}}, {0.2, -1e-300}}};
  return row;
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

std::string line_of(const SweepRow& row) {
  std::string line = row_line(row, plan);
  EXPECT_EQ(line.back(), '\n');
  line.pop_back();
  EXPECT_EQ(line.find('\n'), std::string::npos);
  return line;
}

TEST(SweepRow, is_read_back_to_the_bit) {
  const SweepRow row = example();
  const auto back = read_row(line_of(row), plan);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id, row.id);
  EXPECT_EQ(back->attempt, 3U);
  EXPECT_EQ(back->outcome, SweepOutcome::diverged);
  EXPECT_EQ(back->reason, row.reason);
  EXPECT_EQ(back->name, row.name);
  EXPECT_EQ(back->remarks, row.remarks);
  ASSERT_EQ(back->values.size(), row.values.size());
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    EXPECT_EQ(back->values[i].name, row.values[i].name);
    expect_same(back->values[i].value, row.values[i].value);
  }
  EXPECT_EQ(back->curve.columns, row.curve.columns);
  ASSERT_EQ(back->curve.rows.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) expect_same(back->curve.rows[i][k], row.curve.rows[i][k]);
  EXPECT_EQ(row_line(*back, plan), row_line(row, plan));
}

TEST(SweepRow, its_head_is_read_alone) {
  const std::string line = line_of(example());
  const auto head = read_head(line, plan);
  ASSERT_TRUE(head);
  EXPECT_EQ(head->id, 0x0123456789abcdefU);
  EXPECT_EQ(head->attempt, 3U);
  EXPECT_EQ(head->outcome, SweepOutcome::diverged);
  EXPECT_EQ(id_text(head->seal), line.substr(0, 16));
}

// Rows of older runs must stay readable: this text is a promise.
TEST(SweepRow, has_this_form) {
  SweepRow row{.id = 255, .name = "a"};
  row.values = {{"force_N", 1.5}, {"model", std::string("hertz")}};
  EXPECT_EQ(row_line(row, "p").substr(16),
            "\t00000000000000ff\t1\tcompleted\t\ta\t2\tforce_N\t1.5\tmodel\t\"hertz\t0\t0\t0\n");
}

TEST(SweepRow, a_torn_line_is_none) {
  const std::string line = line_of(example());
  for (std::size_t length = 0; length < line.size(); ++length) {
    EXPECT_FALSE(read_row(std::string_view(line).substr(0, length), plan)) << length;
    EXPECT_FALSE(read_head(std::string_view(line).substr(length + 1), plan)) << length;
  }
}

TEST(SweepRow, a_line_with_a_wrong_byte_is_none) {
  const std::string line = line_of(example());
  for (std::size_t at = 0; at < line.size(); ++at)
    for (const int change : {1, 32, 128}) {
      std::string wrong = line;
      wrong[at] = static_cast<char>(wrong[at] ^ change);
      EXPECT_FALSE(read_row(wrong, plan)) << at;
    }
}

TEST(SweepRow, a_row_of_another_plan_is_none) {
  EXPECT_FALSE(read_row(line_of(example()), std::string(64, 'b')));
}

TEST(SweepRow, ids_are_sixteen_digits) {
  EXPECT_EQ(id_text(0x00ff00000000000aU), "00ff00000000000a");
  EXPECT_EQ(id_of("00ff00000000000a"), 0x00ff00000000000aU);
  for (const char* wrong : {"", "ff", "00ff00000000000g", "+0ff00000000000a", "00ff00000000000a0"})
    EXPECT_FALSE(id_of(wrong)) << wrong;
}

}  // namespace
}  // namespace palpate::study
