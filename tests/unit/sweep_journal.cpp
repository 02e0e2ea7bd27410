// Rows on the disk: whatever happens to the files, a row is either there or known to be missing.
#include "sweep/journal.h"

#include "sweep_folder.h"

namespace palpate::sweep {
namespace {

class Journals : public SweepFolder {
 protected:
  // A plan that nothing but rows is asked of.
  Journals() {
    plan_.folder = root_.string();
    plan_.hash = std::string(64, '1');
    for (std::uint64_t i = 0; i < 8; ++i) plan_.ids.push_back(1000 - 7 * i);
  }

  [[nodiscard]] SweepRow row(std::size_t index, double force = 1.0, std::uint32_t attempt = 1,
                             SweepOutcome outcome = SweepOutcome::completed) const {
    SweepRow one{.id = plan_.ids[index], .attempt = attempt, .outcome = outcome};
    one.name = "case " + std::to_string(index);
    one.values = {{"force_N", force}};
    return one;
  }
  // A file with the rows of these cases; its path.
  std::string keep(const std::vector<SweepRow>& rows, const std::string& part = "1-of-1") {
    record::Journal journal(plan_.folder + "/results", part, plan_.hash);
    for (const SweepRow& one : rows) journal.add(journal_row(one));
    journal.sync();
    return journal.path();
  }
  [[nodiscard]] std::set<std::size_t> known() const {
    const SweepResults results(plan_);
    std::set<std::size_t> numbers;
    for (std::size_t i = 0; i < plan_.count(); ++i)
      if (results.at(i).known()) numbers.insert(i);
    return numbers;
  }

  SweepPlan plan_;
};

using Numbers = std::set<std::size_t>;

TEST_F(Journals, every_row_is_found_again) {
  keep({row(3), row(0)});
  keep({row(7, 2.5)}, "2-of-2");
  EXPECT_EQ(known(), (Numbers{0, 3, 7}));
  const SweepResults results(plan_);
  EXPECT_EQ(results.row(7).values[0].value, record::Cell(2.5));
  EXPECT_EQ(results.row(3).name, "case 3");
  ASSERT_EQ(results.files().size(), 2U);
  EXPECT_EQ(results.files()[0].rows, 2U);
  EXPECT_EQ(results.corrupt(), 0U);
  EXPECT_TRUE(results.warnings().empty());
}

TEST_F(Journals, no_two_have_one_file) {
  EXPECT_NE(keep({row(0)}), keep({row(1)}));
  EXPECT_EQ(known(), (Numbers{0, 1}));
}

// Files as such: record_journal.
TEST_F(Journals, torn_and_corrupt_lines_are_counted) {
  const std::string path = keep({row(0), row(1), row(2)});
  std::string text = read(path);
  text[text.find("completed")] = 'x';
  write(path, text.substr(0, text.size() - 1));
  EXPECT_EQ(known(), Numbers{1});
  EXPECT_EQ(SweepResults(plan_).corrupt(), 2U);
  EXPECT_EQ(SweepResults(plan_).warnings().size(), 2U);
}

TEST_F(Journals, a_part_reads_no_file_of_other_parts) {
  keep({row(1)}, "2-of-3");
  keep({row(2)}, "3-of-3");
  keep({row(4)}, "1-of-2");
  keep({row(5)}, "retry-3-of-3");
  keep({row(7)}, "retry");
  const SweepResults results(plan_, {2, 3});
  Numbers seen;
  for (std::size_t i = 0; i < plan_.count(); ++i)
    if (results.at(i).known()) seen.insert(i);
  EXPECT_EQ(seen, (Numbers{1, 4, 7}));
  EXPECT_EQ(known(), (Numbers{1, 2, 4, 5, 7}));
}

TEST_F(Journals, rows_of_another_plan_count_for_nothing) {
  const std::string path = keep({row(0)});
  plan_.hash[5] = '2';
  EXPECT_EQ(known(), Numbers{});
  EXPECT_EQ(SweepResults(plan_).corrupt(), 0U);
  EXPECT_EQ(
      SweepResults(plan_).warnings(),
      std::vector<std::string>{path + " belongs to another plan, chart or version and is ignored"});
}

TEST_F(Journals, a_row_of_no_case_is_corrupt) {
  SweepRow stranger = row(0);
  stranger.id = 5;
  keep({stranger, row(1)});
  EXPECT_EQ(known(), Numbers{1});
  EXPECT_EQ(SweepResults(plan_).corrupt(), 1U);
}

TEST_F(Journals, equal_rows_are_one) {
  keep({row(2), row(2)});
  keep({row(2)});
  EXPECT_EQ(known(), Numbers{2});
}

TEST_F(Journals, different_rows_of_one_case_are_refused) {
  const std::string first = keep({row(2, 1.0)}, "1-of-2");
  const std::string second = keep({row(2, 1.0 + 1e-15)}, "2-of-2");
  const std::string said = refusal([&] { (void)SweepResults(plan_); });
  EXPECT_EQ(said,
            "case 3 (00000000000003da) has two different results, in results/" +
                fs::path(first).filename().string() + " and results/" +
                fs::path(second).filename().string() +
                ": the machines that made them do not compute alike; remove one of the files");
  EXPECT_THROW((void)SweepResults(plan_), SystemError);
}

TEST_F(Journals, the_last_attempt_counts_whatever_the_files_are_called) {
  for (const char* part : {"a", "z"}) {
    fs::remove_all(root_ / "results");
    keep({row(4, 1.0, 1, SweepOutcome::failed)}, "m");
    keep({row(4, 2.0, 3), row(4, 1.5, 2, SweepOutcome::failed)}, part);
    const SweepResults results(plan_);
    EXPECT_EQ(results.at(4).head.attempt, 3U);
    EXPECT_EQ(results.row(4).values[0].value, record::Cell(2.0));
    const SweepTotals totals = count_results(plan_, results);
    EXPECT_EQ(totals.completed, 1U);
    EXPECT_EQ(totals.failed, 0U);
    EXPECT_EQ(totals.missing_numbers, "1-4,6-8");
  }
}

}  // namespace
}  // namespace palpate::sweep
