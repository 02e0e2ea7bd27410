// The rows of a live loop, which another thread collects and writes to the disk.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/files.h"
#include "device/tap.h"
#include "record/record.h"

namespace palpate::live {

// A file that grows during a live run; errors are kept as a sentence and do not end the run.
class LiveFile {
 public:
  // The file is created by the first append(). With an empty path nothing is ever written.
  explicit LiveFile(std::string path);

  // Appends whole lines of `text`, which ends with a line feed, and returns how many bytes were
  // written. For a second after a failure it writes nothing and returns 0.
  std::size_t append(std::string_view text);
  // Flushes written text to the disk, at most once a second.
  void sync_when_due();
  // Flushes it now.
  void sync();
  // After a failure, lets the next append() try at once.
  void try_again() { next_try_ = {}; }

  // The first error, as `force_indentation.csv cannot be written: No space left on device`, if any.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] bool named() const { return !path_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::size_t next_piece(std::string_view text) const;
  void fail(const std::string& why);

  std::string path_;
  std::unique_ptr<GrowingFile> file_;
  std::size_t size_ = 0;  // bytes
  std::string trouble_;
  bool dirty_ = false;  // some text is not on the disk yet
  Clock::time_point next_sync_{};
  Clock::time_point next_try_{};
};

struct LogRow {
  record::ContactRow contact;
  record::MeasuredRow measured;
};

struct LogPlan {
  // A CSV file with the columns of force_indentation.csv that receives every row during the run;
  // empty: rows are kept in memory only.
  std::string rows_file = {};
  std::string case_name = {};  // for the column `case`
  record::Table (*table)(const std::vector<record::CaseRecord>&) = record::contact_table;
  // The traffic to write to `traffic_file`, or null; outlives the log.
  device::Tap* tap = nullptr;
  std::string traffic_file = {};  // CSV: `time_s,way,bytes`, one line per write or read
  // Called with a sentence if a file cannot be written, once per file, on the log's thread, and in
  // finish() if rows or traffic were lost.
  std::function<void(const std::string&)> on_trouble = {};
  // If the disk is slower than the loop: with a device the loop drops the row; in lock-step and
  // with a recording, for which nothing waits, the loop waits for the disk.
  enum class WhenFull { drop, wait };
  WhenFull when_full = WhenFull::drop;
};

// The loop pushes rows, and a second thread collects them; the loop waits only with WhenFull::wait.
class LiveLog {
 public:
  static constexpr std::size_t capacity = 32768;  // rows: half a minute at 1 kHz
  // With WhenFull::wait, rows that are not yet in the file, unless writing failed.
  static constexpr std::size_t lead = 1000;

  // `on_step` is called on the log's thread when a row belongs to another step than the one before.
  explicit LiveLog(std::function<void(int step)> on_step, LogPlan plan = {});
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  void push(const LogRow& row) {  // allocates nothing
    if (plan_.when_full == LogPlan::WhenFull::wait) wait_for_room();
    (void)ring_->push(row);
    ++pushed_;
  }
  // Ends the thread and returns all rows in order. Call once.
  [[nodiscard]] std::vector<LogRow> finish();
  // After finish(): whether all rows are in the file and on the disk, and the file never failed.
  [[nodiscard]] bool rows_are_written() const { return written_; }
  // After finish(): all sentences passed to on_trouble.
  [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }
  [[nodiscard]] std::uint64_t dropped() const { return ring_->dropped(); }

 private:
  bool collect();
  bool collect_traffic();
  bool collect_rows();
  bool write_rows();
  void tell(std::string sentence);
  void wait_for_room() const;
  void work();

  using Rows = device::Ring<LogRow, capacity>;
  std::unique_ptr<Rows> ring_ = std::make_unique<Rows>();
  std::function<void(int)> on_step_;
  LogPlan plan_;
  LiveFile rows_file_;
  LiveFile traffic_file_;
  std::vector<std::string> troubles_;
  bool rows_told_ = false;     // an error of the file of rows was reported
  bool traffic_told_ = false;  // likewise; no more traffic is written then
  std::string bytes_;          // the parts so far of one write or read
  double first_time_ = -1.0;   // s, wire time of the first part; negative: none yet
  std::vector<LogRow> rows_;
  bool has_header_ = false;                // the header is in the file of rows
  std::size_t in_file_ = 0;                // number of `rows_` in the file
  std::vector<record::CaseRecord> piece_;  // one record, with the rows being written
  std::uint64_t pushed_ = 0;               // rows, counted by the loop
  std::atomic<std::uint64_t> done_ = 0;    // rows written, or kept in memory where writing failed
  int step_ = 0;
  bool written_ = false;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace palpate::live
