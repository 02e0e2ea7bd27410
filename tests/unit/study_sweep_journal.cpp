// Rows on the disk: whatever happens to the files, a row is either there or known to be missing.
#include "study/sweep_journal.h"

#include <sys/resource.h>

#include <csignal>

#include "sweep_folder.h"

namespace palpate::study {
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
    SweepJournal journal(plan_, part);
    for (const SweepRow& one : rows) journal.add(one);
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

TEST_F(Journals, a_file_torn_anywhere_has_all_rows_before_that) {
  const std::string path = keep({row(0), row(1), row(2)});
  const std::string whole = read(path);
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    write(path, whole.substr(0, length));
    const auto lines = std::count(whole.begin(), whole.begin() + static_cast<long>(length), '\n');
    Numbers expected;
    for (long i = 1; i < lines; ++i) expected.insert(static_cast<std::size_t>(i - 1));
    EXPECT_EQ(known(), expected) << length;
    const bool torn = length > 0 && whole[length - 1] != '\n';
    EXPECT_EQ(SweepResults(plan_).corrupt(), torn ? 1U : 0U) << length;
    EXPECT_EQ(SweepResults(plan_).warnings().size(), torn ? 1U : 0U) << length;
  }
}

// The first line, too: rows stand for themselves.
TEST_F(Journals, a_wrong_byte_costs_one_row) {
  const std::string path = keep({row(0), row(1), row(2)});
  const std::string whole = read(path);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string wrong = whole;
    wrong[at] = whole[at] == 'x' ? 'y' : 'x';
    write(path, wrong);
    // A line feed that is lost joins two lines; the last one leaves a torn line.
    const auto line = static_cast<std::size_t>(
        std::count(whole.begin(), whole.begin() + static_cast<long>(at), '\n'));
    Numbers expected{0, 1, 2};
    if (line > 0) expected.erase(line - 1);
    if (whole[at] == '\n') expected.erase(line);
    EXPECT_EQ(known(), expected) << at;
  }
}

TEST_F(Journals, a_part_reads_no_file_of_other_parts) {
  keep({row(1)}, "2-of-3");
  keep({row(2)}, "3-of-3");
  keep({row(4)}, "1-of-2");
  keep({row(7)}, "retry");
  const SweepResults results(plan_, {2, 3});
  Numbers seen;
  for (std::size_t i = 0; i < plan_.count(); ++i)
    if (results.at(i).known()) seen.insert(i);
  EXPECT_EQ(seen, (Numbers{1, 4, 7}));
  EXPECT_EQ(known(), (Numbers{1, 2, 4, 7}));
}

TEST_F(Journals, rows_of_another_plan_count_for_nothing) {
  const std::string path = keep({row(0)});
  plan_.hash[5] = '2';
  EXPECT_EQ(known(), Numbers{});
  EXPECT_EQ(SweepResults(plan_).corrupt(), 0U);
  EXPECT_EQ(SweepResults(plan_).warnings(),
            std::vector<std::string>{
                path + " is of another plan or another version and counts for nothing"});
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

// A file that may not grow is a disk that is full; the limit kills by a signal unless that is
// ignored.
TEST_F(Journals, a_full_disk_keeps_what_was_there) {
  std::signal(SIGXFSZ, SIG_IGN);
  SweepJournal journal(plan_, "1-of-1");
  journal.add(row(0));
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{fs::file_size(journal.path()) + 40, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &tight);
  const std::string said = refusal([&] { journal.add(row(1)); });
  const std::string text = read(journal.path());
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(said, "results/" + fs::path(journal.path()).filename().string() +
                      " cannot be written: File too large");
  EXPECT_EQ(text.back(), '\n') << "half a line was left";
  journal.add(row(2));
  EXPECT_EQ(known(), (Numbers{0, 2}));
}

}  // namespace
}  // namespace palpate::study
