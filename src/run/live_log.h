// What a live loop leaves behind, row by row, taken over by another thread and onto the disk.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "device/ring.h"
#include "device/tap.h"
#include "record/record.h"
#include "run/live_file.h"

namespace palpate::run {

struct LogRow {
  record::ContactRow contact;
  record::MeasuredRow measured;
};

struct LogPlan {
  // A CSV file that is to have every row as soon as it is known, as force_indentation.csv has it;
  // empty: rows are in memory only.
  std::string rows_file = {};
  std::string case_name = {};  // of its first column
  // Is emptied into `traffic_file` and outlives the log.
  device::Tap* tap = nullptr;
  std::string traffic_file = {};  // CSV: `time_s,way,bytes`, a line a write or read
  // Called with a sentence where a file cannot be written, once a file, on the log's thread; and in
  // finish() where something found no room.
  std::function<void(const std::string&)> on_trouble = {};
  // Where the disk is slower than the loop: a loop that a device waits for goes on without the row,
  // one that nobody waits for, as of a recording, waits.
  enum class WhenFull { drop, wait };
  WhenFull when_full = WhenFull::drop;
};

// The loop pushes, a thread of its own collects; whatever that does with a row, the loop never
// waits for it, unless that is what is planned.
class LiveLog {
 public:
  static constexpr std::size_t capacity = 32768;  // rows: half a minute of 1 kHz

  // `on_step` is called on the log's thread when the rows go over to another step.
  explicit LiveLog(std::function<void(int step)> on_step, LogPlan plan = {});
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  void push(const LogRow& row) {  // allocates nothing
    if (plan_.when_full == LogPlan::WhenFull::wait) wait_for_room();
    (void)ring_->push(row);
    ++pushed_;
  }
  // Ends the thread and gives all rows, in order. Once.
  [[nodiscard]] std::vector<LogRow> finish();
  // After finish(): whether all rows are in the file and on the disk, and nothing ever went wrong
  // with it.
  [[nodiscard]] bool rows_are_written() const { return written_; }
  // After finish(): all that on_trouble was told.
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
  bool rows_told_ = false;     // that there is trouble with the file
  bool traffic_told_ = false;  // likewise; then nothing more is kept of the traffic
  std::string bytes_;          // of a write or read that came in parts
  double first_time_ = -1.0;   // s, wire time
  std::vector<LogRow> rows_;
  bool has_header_ = false;                // the file of rows
  std::size_t in_file_ = 0;                // so many of `rows_`
  std::vector<record::CaseRecord> piece_;  // one: the rows on their way to the file
  std::uint64_t pushed_ = 0;               // the loop's own count
  std::atomic<std::uint64_t> taken_ = 0;   // out of the ring
  int step_ = 0;
  bool written_ = false;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace palpate::run
