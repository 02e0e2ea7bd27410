// Columns of a sweep's results: which are taken, what a failed case leaves, what is refused.
#include "sweep/columns.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "refusal.h"
#include "scenario_text.h"

namespace palpate::sweep {
namespace {

using record::Cell;
using Names = std::vector<std::string>;

const std::string completed = "completed";

record::Table results() {
  record::Table table;
  table.columns = {"number",
                   "id",
                   "tissue.young_modulus_kPa",
                   "tissue.material",
                   "outcome",
                   "reason",
                   "nodes",
                   "peak_force_N",
                   "force_at_2_mm_N",
                   "force_indentation_power_n",
                   "force_indentation_logarithmic_b_N",
                   "force_at_1_mm_N"};
  const auto row = [&](double modulus, const char* material, const char* outcome, double force) {
    table.rows.push_back({1.0, std::string("a"), modulus, std::string(material),
                          std::string(outcome), Cell(), 27.0 + modulus, force,
                          modulus > 15 ? Cell(force) : Cell(), force + 1.0, 5.0, force / 2.0});
  };
  row(10, "skin", "completed", 1.0);
  row(10, "bone", "completed", 2.0);
  row(20, "skin", "diverged", 3.0);
  row(20, "bone", "completed", 4.0);
  return table;
}

ColumnChoice choice(std::vector<std::string> show = {}) {
  return {scenario::Design::Kind::grid,
          {{.name = "tissue.young_modulus", .column = "tissue.young_modulus_kPa", .levels = 2},
           {.name = "tissue.material", .column = "tissue.material", .levels = 2}},
          std::move(show)};
}

SweepColumns sweep_columns(const ColumnChoice& choice, const record::Table& table) {
  ColumnReader reader(choice, table.columns);
  for (const auto& row : table.rows) reader.add(row);
  return reader.finish();
}

Names names(const SweepColumns& columns) {
  Names all;
  for (const OutputColumn& output : columns.outputs) all.push_back(output.name);
  return all;
}

using test::refusal;

TEST(SweepColumns, TakeTheUsualOutputsThatAreWholeAndVary) {
  const SweepColumns columns = sweep_columns(choice(), results());
  // Not force_at_2_mm_N, which completed cases lack; not ..._b, which is the same in all.
  EXPECT_EQ(names(columns), (Names{"force_at_1_mm_N", "peak_force_N"}));
  EXPECT_EQ(columns.cases, 4u);
  EXPECT_EQ(columns.factors[0].values, (std::vector<double>{10, 10, 20, 20}));
  EXPECT_TRUE(columns.factors[0].is_number());
  EXPECT_EQ(columns.factors[1].values, (std::vector<double>{0, 1, 0, 1}));
  EXPECT_EQ(columns.factors[1].words, (Names{"skin", "bone"}));
  EXPECT_TRUE(columns.notes.empty());
}

// Coefficients of a fit are no response that anyone asked for; the displacement is one where the
// force is given, and otherwise what was given.
TEST(SweepColumns, AreForcesAndModuliOrTheDisplacementUnderAForce) {
  const auto with = [](const char* column, double first) {
    record::Table table = results();
    table.columns.back() = column;
    for (std::size_t i = 0; i < 4; ++i)
      table.rows[i].back() = first + 0.1 * static_cast<double>(i + 1);
    return table;
  };
  const auto usual = [](const record::Table& table) {
    return names(sweep_columns(choice(), table));
  };
  EXPECT_EQ(usual(with("force_indentation_logarithmic_a_N", 1.0)), Names{"peak_force_N"});
  EXPECT_EQ(usual(with("secant_modulus_kPa", 1.0)), (Names{"peak_force_N", "secant_modulus_kPa"}));
  record::Table table = with("peak_travel_mm", 1.0);
  EXPECT_EQ(usual(table), Names{"peak_force_N"});
  for (auto& row : table.rows) row[7] = 2.0;  // the force is the same in all cases
  EXPECT_EQ(usual(table), Names{"peak_travel_mm"});
}

TEST(SweepColumns, LeaveOutWhatACompletedCaseLacks) {
  record::Table table = results();
  const auto column = as_index(table.find("force_at_2_mm_N"));
  table.rows[0][column] = 0.5;  // it varies now, and the second case has none
  for (const OutputColumn& output : sweep_columns(choice(), table).outputs)
    EXPECT_NE(output.name, "force_at_2_mm_N");
}

TEST(SweepColumns, AFailedCaseHasNoOutputs) {
  const SweepColumns columns = sweep_columns(choice(), results());
  EXPECT_EQ(columns.outputs[1].values[1], 2.0);
  EXPECT_TRUE(std::isnan(columns.outputs[1].values[2]));  // it diverged
}

TEST(SweepColumns, TakeWhatIsAskedForThough) {
  EXPECT_EQ(names(sweep_columns(choice({"force_at_2_mm_N", "peak_force_N"}), results())),
            Names{"peak_force_N"});  // one case with a value does not vary
  EXPECT_EQ(
      sweep_columns(choice({"force_at_2_mm_N"}), results()).notes,
      Names{"`force_at_2_mm_N` has the same value, or none, in every case: there is nothing to "
            "draw"});
  EXPECT_EQ(names(sweep_columns(choice({"nodes"}), results())), Names{"nodes"});
  EXPECT_EQ(refusal([] { (void)sweep_columns(choice({"peak_forc_N"}), results()); }),
            "the results have no column `peak_forc_N`; did you mean `peak_force_N`?");
  EXPECT_EQ(refusal([] { (void)sweep_columns(choice({"tissue.material"}), results()); }),
            "the column `tissue.material` holds words, such as `skin`; `--show` wants a column of "
            "numbers");
}

TEST(SweepColumns, SayWhereNothingIsThereToDraw) {
  record::Table table = results();
  for (auto& row : table.rows) row[4] = std::string("missing");
  EXPECT_TRUE(sweep_columns(choice(), table).notes.empty()) << "no other column would have a value";
  table.rows[0][4] = std::string("completed");
  const SweepColumns columns = sweep_columns(choice(), table);
  EXPECT_TRUE(columns.outputs.empty());
  ASSERT_EQ(columns.notes.size(), 1u);
  EXPECT_NE(columns.notes[0].find("give `output.force_at`, or choose a column by `--show`"),
            std::string::npos);
}

TEST(SweepColumns, NumbersWithAWordAmongThemAreWords) {
  record::Table table = results();
  table.rows[2][2] = std::string("auto");
  const SweepColumns columns = sweep_columns(choice(), table);
  EXPECT_EQ(columns.factors[0].words, (Names{"10", "auto", "20"}));
  EXPECT_EQ(columns.factors[0].values, (std::vector<double>{0, 0, 1, 2}));
}

TEST(SweepColumns, ReadInPartsAreThoseOfTheWholeFile) {
  const auto family = scenario::parse(
      scenario::press +
          "[sweep]\n\"tissue.young_modulus\" = [\"1 kPa\", \"10 kPa\", \"100 kPa\"]\n"
          "\"tissue.poisson_ratio\" = { from = 0.1, to = 0.4, points = 4 }\n",
      "press.toml", {});
  std::string text =
      "number,id,tissue.young_modulus_kPa,tissue.poisson_ratio,outcome,reason,peak_force_N\n";
  std::size_t rows = 0;
  while (text.size() < 600000) {  // more than two parts
    text += std::to_string(rows + 1) + ",ab," + (rows % 2 == 0 ? "1" : "100") + ",0.25," +
            (rows % 3 == 0 ? "diverged,\"a reason, with\na line break\"," : "completed,,") +
            std::to_string(rows) + "\n";
    ++rows;
  }
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("sweep_columns_" + std::to_string(::getpid()) + ".csv"))
                               .string();
  write_atomically(path, text);
  const SweepColumns columns = read_sweep_columns(path, family.design, {});
  std::filesystem::remove(path);
  EXPECT_EQ(columns.cases, rows);
  ASSERT_EQ(columns.outputs.size(), 1u);
  for (std::size_t i = 1; i < rows; i += i % 3 == 1 ? 1 : 2)  // those that completed
    ASSERT_EQ(columns.outputs[0].values[i], static_cast<double>(i));
  EXPECT_EQ(columns.factors[0].choice.column, "tissue.young_modulus_kPa");
  EXPECT_EQ(columns.factors[0].choice.levels, 3u);
  EXPECT_EQ(columns.factors[0].choice.scale, Scale::logarithmic);  // a list from 1 to 100
  EXPECT_EQ(columns.factors[1].choice.scale, Scale::linear);
}

}  // namespace
}  // namespace palpate::sweep
