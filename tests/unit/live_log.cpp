// A live run's log: what it writes while it goes on is what the result would have; no disk stops
// it, and what it cannot keep it counts.
#include "live/loop.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <future>
#include <thread>

#include "base/files.h"
#include "base/text.h"
#include "patience.h"
#include "record/csv.h"
#include "refused_call.h"
#include "temporary_folder.h"

namespace palpate::live {
namespace {

LogRow row(int i, int step = 1) {
  LogRow row;
  row.contact.step = step;
  row.contact.time = 1e-3 * i;
  row.contact.travel = 1e-6 * i;
  row.contact.force = 0.1 / (1.0 + i);
  row.measured.place = {1e-5 * i, 0.0, -1e-6 * i};
  if (i % 2 == 0) row.measured.force = 0.01 * i;
  return row;
}

// As the result has it.
std::string table_text(const std::vector<LogRow>& rows) {
  record::CaseRecord record;
  record.name = "a case, its name";
  for (const LogRow& row : rows) {
    record.contact.push_back(row.contact);
    record.measured.push_back(row.measured);
  }
  return record::csv_text(record::contact_table({record}));
}

// Of a file that may not be there yet.
std::string content(const std::filesystem::path& path) {
  return std::filesystem::exists(path) ? test::read_file(path) : std::string();
}

// Files of this process end at `size` bytes, as on a full disk, for root too.
class FullDisk {
 public:
  explicit FullDisk(rlim_t size) {
    before_handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit tight{size, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &tight);
  }
  ~FullDisk() { end(); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  void end() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, before_handler_);
  }

 private:
  rlimit before_{};
  sighandler_t before_handler_ = SIG_DFL;
};

// How often this process has written.
double writes() {
  const std::string text = test::read_file("/proc/self/io");
  return leading_number(text.substr(text.find("syscw: ") + 7))->value;
}

// SIGKILL may end a write at the end of a page of the file, and no line shall be cut there.
TEST(LiveFiles, are_written_page_by_page) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "rows.csv";
  std::string line(100, 'x');
  line.back() = '\n';
  std::string text;
  for (int i = 0; i < 60; ++i) text += line;
  LiveFile file(path);
  const double before = writes();
  EXPECT_EQ(file.append(text), text.size());
  // 40 lines fit into the first page, one lies on its end, and 19 are left.
  EXPECT_EQ(writes() - before, 3.0);
  EXPECT_EQ(content(path), text);
}

TEST(LiveFiles, are_on_the_disk_within_a_second) {
  const test::TemporaryFolder folder;
  // Whether the disk was asked at once (1), and whether after a second (2).
  const auto asked = [&] {
    test::refuse(SYS_fsync, EIO);
    LiveFile file(folder / "rows.csv");
    (void)file.append("1,2\n");
    file.sync_when_due();
    const int at_once = file.trouble().empty() ? 0 : 1;
    std::this_thread::sleep_for(std::chrono::seconds(1));
    file.sync_when_due();
    std::_Exit(at_once + (file.trouble().empty() ? 0 : 2));
  };
  EXPECT_EXIT(asked(), testing::ExitedWithCode(2), "");
}

class LiveLogs : public testing::Test {
 protected:
  LogPlan plan() {
    return {.rows_file = path_,
            .case_name = "a case, its name",
            .on_trouble = [this](const std::string& told) {
              told_.push_back(told);
              ++times_told_;
            }};
  }
  static void ignore(int) {}

  test::TemporaryFolder folder_;
  std::string path_ = (folder_ / "rows.csv").string();
  std::vector<std::string> told_;  // to be read after finish()
  std::atomic<int> times_told_ = 0;
};

TEST_F(LiveLogs, the_file_is_the_table) {
  LiveLog log(ignore, plan());
  for (int i = 0; i < 10000; ++i) log.push(row(i));  // more than are written at a time
  const std::vector<LogRow> rows = log.finish();
  ASSERT_EQ(rows.size(), 10000U);
  EXPECT_EQ(content(path_), table_text(rows));
  EXPECT_TRUE(log.rows_are_written());
  EXPECT_TRUE(log.troubles().empty());
}

TEST_F(LiveLogs, rows_are_in_the_file_while_it_goes_on) {
  LiveLog log(ignore, plan());
  std::vector<LogRow> rows;
  for (int i = 0; i < 3; ++i) {
    rows.push_back(row(i));
    log.push(rows.back());
    EXPECT_TRUE(test::seen([&] { return content(path_) == table_text(rows); })) << i;
  }
}

// What is more than the disk takes at once: as many lines as fit are there.
TEST_F(LiveLogs, of_many_rows_a_full_disk_has_those_that_fit) {
  FullDisk disk(20000);
  std::promise<void> go_on;
  LiveLog log([&](int) { go_on.get_future().wait(); }, plan());
  std::vector<LogRow> rows;
  for (int i = 0; i < 1000; ++i) {
    rows.push_back(row(i));
    log.push(rows.back());
  }
  go_on.set_value();
  EXPECT_TRUE(test::seen([&] { return times_told_ > 0; }));
  const std::string kept = content(path_);
  EXPECT_GT(kept.size(), 20000U - 4096U) << "no more than a page is excluded";
  EXPECT_TRUE(table_text(rows).starts_with(kept));
  EXPECT_EQ(kept.back(), '\n');
  disk.end();
  (void)log.finish();
  EXPECT_EQ(content(path_), table_text(rows));
}

TEST_F(LiveLogs, without_rows_there_is_no_file) {
  LiveLog log(ignore, plan());
  EXPECT_TRUE(log.finish().empty());
  EXPECT_FALSE(log.rows_are_written());
  EXPECT_FALSE(std::filesystem::exists(path_));
}

// A thread that hangs holds nobody up, and the rows that found no room are told to the last one.
TEST_F(LiveLogs, what_finds_no_room_is_counted_and_told) {
  std::promise<void> entered;
  std::promise<void> go_on;
  LiveLog log(
      [&](int) {
        entered.set_value();
        go_on.get_future().wait();
      },
      plan());
  log.push(row(0));
  entered.get_future().wait();
  constexpr int room = static_cast<int>(LiveLog::capacity);
  for (int i = 1; i <= room + 7; ++i) log.push(row(i));
  go_on.set_value();
  const std::vector<LogRow> rows = log.finish();
  EXPECT_EQ(rows.size(), LiveLog::capacity + 1);
  EXPECT_EQ(log.dropped(), 7U);
  EXPECT_EQ(told_, std::vector<std::string>{"7 rows are missing, because the log was full"});
  EXPECT_EQ(log.troubles(), told_);
  EXPECT_TRUE(log.rows_are_written());
  EXPECT_EQ(content(path_), table_text(rows));
}

// A recording comes faster than any disk: its loop waits, and no row is lost.
TEST_F(LiveLogs, one_that_may_wait_loses_nothing) {
  LogPlan waits = plan();
  waits.when_full = LogPlan::WhenFull::wait;
  constexpr int lead = static_cast<int>(LiveLog::lead);
  std::atomic<int> begun = 0;  // rows
  // The disk does nothing until the loop waits.
  LiveLog log([&](int) { EXPECT_TRUE(test::seen([&] { return begun > lead; })); }, waits);
  constexpr int count = 40 * lead + 100;
  for (int i = 0; i < count; ++i) {
    ++begun;
    log.push(row(i));
    // What a killed program leaves: every row but the last ones.
    if (i % lead == 0 && i > lead) {
      const std::string kept = content(path_);
      EXPECT_GE(std::count(kept.begin(), kept.end(), '\n'), 1 + i + 1 - lead);
    }
  }
  const std::vector<LogRow> rows = log.finish();
  EXPECT_EQ(log.dropped(), 0U);
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    ASSERT_EQ(rows[static_cast<std::size_t>(i)].contact.time, 1e-3 * i);
}

TEST_F(LiveLogs, a_full_disk_is_told_once_and_tried_again) {
  FullDisk disk(4096);
  LiveLog log(ignore, plan());
  std::vector<LogRow> rows;
  const auto push_ten = [&] {
    for (int i = 0; i < 10; ++i) {
      rows.push_back(row(static_cast<int>(rows.size())));
      log.push(rows.back());
    }
  };
  const std::string whole_lines = [&] {
    std::string before;
    while (true) {  // until a push does not come through for good
      push_ten();
      const bool came =
          test::seen([&] { return content(path_) == table_text(rows) || times_told_ > 0; });
      EXPECT_TRUE(came);
      if (times_told_ > 0 || !came) return before;
      before = table_text(rows);
    }
  }();
  EXPECT_LT(whole_lines.size(), 4096U);
  // Of the rows that did not all fit some, whole ones.
  const std::string kept = content(path_);
  EXPECT_TRUE(kept.starts_with(whole_lines));
  EXPECT_TRUE(table_text(rows).starts_with(kept));
  EXPECT_EQ(kept.back(), '\n');
  push_ten();
  disk.end();
  const std::vector<LogRow> all = log.finish();
  EXPECT_EQ(all.size(), rows.size());
  EXPECT_EQ(content(path_), table_text(rows)) << "tried once more at the end";
  EXPECT_FALSE(log.rows_are_written()) << "it is written anew to be sure";
  EXPECT_EQ(told_,
            std::vector<std::string>{"rows.csv cannot be written: File too large; until the run "
                                     "ends its rows are in memory"});
}

// By itself, while the run goes on.
TEST_F(LiveLogs, a_disk_that_has_room_again_gets_all_rows) {
  FullDisk disk(1);
  LiveLog log(ignore, plan());
  std::vector<LogRow> rows{row(0), row(1)};
  for (const LogRow& each : rows) log.push(each);
  ASSERT_TRUE(test::seen([&] { return times_told_ > 0; }));
  disk.end();
  EXPECT_TRUE(test::seen([&] { return content(path_) == table_text(rows); }));
}

TEST_F(LiveLogs, a_file_that_cannot_be_made_costs_no_row) {
  LogPlan nowhere = plan();
  nowhere.rows_file = (folder_ / "none/rows.csv").string();
  LiveLog log(ignore, nowhere);
  for (int i = 0; i < 5; ++i) log.push(row(i));
  EXPECT_EQ(log.finish().size(), 5U);
  EXPECT_FALSE(log.rows_are_written());
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_TRUE(told_[0].starts_with("rows.csv cannot be made: No such file or directory; "))
      << told_[0];
}

TEST_F(LiveLogs, traffic_goes_to_its_file) {
  device::Tap tap;
  LogPlan with = plan();
  with.tap = &tap;
  with.traffic_file = (folder_ / "traffic.csv").string();
  LiveLog log(ignore, with);
  tap.note(device::Tap::Way::sent, "n\r");
  std::string line(500, 'x');
  line += '\n';
  tap.note(device::Tap::Way::received, line);
  ASSERT_TRUE(test::seen([&] { return content(with.traffic_file).ends_with("x\\n\"\n"); }));
  const std::string text = content(with.traffic_file);
  EXPECT_TRUE(text.starts_with("time_s,way,bytes\n0,sent,\"n\\r\"\n")) << text;
  EXPECT_NE(text.find(",received,\"" + std::string(500, 'x') + "\\n\"\n"), std::string::npos);
  tap.note(device::Tap::Way::sent, "s");
  (void)log.finish();
  EXPECT_TRUE(content(with.traffic_file).ends_with(",sent,\"s\"\n")) << "the last of it, too";
  EXPECT_TRUE(told_.empty());
}

// Traffic of an hour is gigabytes: where the disk takes none of it, it is not hoarded.
TEST_F(LiveLogs, traffic_that_the_disk_does_not_take_is_told) {
  device::Tap tap;
  LogPlan with = plan();
  with.tap = &tap;
  with.traffic_file = (folder_ / "none/traffic.csv").string();
  LiveLog log(ignore, with);
  for (int i = 0; i < 100; ++i) tap.note(device::Tap::Way::sent, "n\r");
  log.push(row(0));
  (void)log.finish();
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(
      told_[0],
      "traffic.csv cannot be made: No such file or directory; no more of the traffic is kept");
  EXPECT_TRUE(log.rows_are_written()) << "the rows are";
}

}  // namespace
}  // namespace palpate::live
