// Swept words as numbers with a unit, numbers as ranges, words for a shell.
#include <gtest/gtest.h>

#include "base/text.h"
#include "record/table.h"
#include "sweep/plan.h"
#include "sweep/slurm.h"

namespace palpate::sweep {
namespace {

using Cells = std::vector<record::Cell>;

struct Column {
  std::string name;
  Cells cells;
  bool operator==(const Column&) const = default;
};

Column column(const std::vector<std::string>& words) {
  record::SweptColumn swept("k");
  for (const std::string& word : words) swept.see(record::swept_cell(word));
  Column made{swept.name(), {}};
  for (const std::string& word : words) made.cells.push_back(swept.cell(record::swept_cell(word)));
  return made;
}

TEST(SweptColumns, quantities_are_numbers_in_one_unit) {
  EXPECT_EQ(column({"20 kPa", "0.1 MPa", "5e2 Pa"}), (Column{"k_kPa", {20.0, 100.0, 0.5}}));
  EXPECT_EQ(column({"3 mm", "1 cm"}), (Column{"k_mm", {3.0, 10.0}}));
  EXPECT_EQ(column({"1 cm", "3 mm"}), (Column{"k_mm", {10.0, 3.0}}));
  EXPECT_EQ(column({"1100 kg/m^3"}), (Column{"k_kg_per_m3", {1100.0}}));
  EXPECT_EQ(column({"5 mm/s"}), (Column{"k_mm_per_s", {5.0}}));
  EXPECT_EQ(column({"4 ms", "1 s"}), (Column{"k_ms", {4.0, 1000.0}}));
  EXPECT_EQ(column({"2 1/s"}), (Column{"k_per_s", {2.0}}));
  EXPECT_EQ(column({"1.5 N s/m"}), (Column{"k_N_s_per_m", {1.5}}));
}

TEST(SweptColumns, numbers_stay_numbers) {
  EXPECT_EQ(column({"0.3", "0.45"}), (Column{"k", {0.3, 0.45}}));
}

TEST(SweptColumns, other_words_stay_words) {
  const std::string auto_word = "auto";
  EXPECT_EQ(column({"skin", "muscle"}),
            (Column{"k", {std::string("skin"), std::string("muscle")}}));
  EXPECT_EQ(column({"4 ms", "auto"}), (Column{"k", {std::string("4 ms"), auto_word}}));
  EXPECT_EQ(column({"auto", "4 ms"}), (Column{"k", {auto_word, std::string("4 ms")}}));
  EXPECT_EQ(column({"2", "auto"}), (Column{"k", {std::string("2"), auto_word}}));
  EXPECT_EQ(column({"3 mm", "2 N"}), (Column{"k", {std::string("3 mm"), std::string("2 N")}}));
  EXPECT_EQ(column({"3 x 4 x 6"}), (Column{"k", {std::string("3 x 4 x 6")}}));
}

TEST(SweepSlurm, numbers_are_told_as_ranges) {
  EXPECT_EQ(number_ranges({}, 0), "");
  EXPECT_EQ(number_ranges({4}, 0), "4");
  EXPECT_EQ(number_ranges({1, 2, 3, 7, 9, 10}, 0), "1-3,7,9-10");
  EXPECT_EQ(number_ranges({1, 3, 5, 6}, 2), "1,3,...");
  EXPECT_EQ(number_ranges({1, 3}, 2), "1,3");
}

TEST(SweepSlurm, words_are_safe_in_a_shell) {
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shown_word("it's $HOME"), shell_word("it's $HOME"));
  EXPECT_EQ(shown_word("tissue.young_modulus=1..500"), "tissue.young_modulus=1..500");
}

TEST(SweepSlurm, the_job_knows_its_parts_by_the_task_alone) {
  const std::string text = slurm_text({.name = "s",
                                       .program = shell_word("/bin/it's"),
                                       .prologue = {},
                                       .folder = "/a b/100%",
                                       .tasks = 16,
                                       .time = "00:10:00"});
  for (const char* line :
       {"#SBATCH --array=1-16\n", "#SBATCH --time=00:10:00\n", "#SBATCH --signal=B:TERM@60\n",
        "#SBATCH --requeue\n", "#SBATCH --output=\"/a b/100%%/logs/%A_%a.log\"\n",
        "\n'/bin/it'\\''s' sweep run ", "--shard \"${SLURM_ARRAY_TASK_ID}/16\""})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  EXPECT_EQ(text.find("TASK_COUNT"), std::string::npos);
}

TEST(SweepSlurm, a_name_cannot_end_its_line) {
  const std::string text = slurm_text({.name = "s\nrm -rf \x1b[31m",
                                       .program = "p",
                                       .prologue = {},
                                       .folder = "f",
                                       .tasks = 1,
                                       .time = ""});
  EXPECT_NE(text.find("--job-name=\"s_rm -rf _[31m\"\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace palpate::sweep
