// What a live loop leaves behind, row by row, taken over by another thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "device/ring.h"
#include "device/tap.h"
#include "record/record.h"

namespace palpate::run {

struct LogRow {
  record::ContactRow contact;
  record::MeasuredRow measured;
};

// The loop pushes, a thread of its own collects; whatever that does with a row, the loop never
// waits for it.
class LiveLog {
 public:
  // `on_step` is called on the log's thread when the rows go over to another step. `tap`, where
  // there is one, is emptied into traffic(), and outlives the log.
  explicit LiveLog(std::function<void(int step)> on_step, device::Tap* tap = nullptr);
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  void push(const LogRow& row) { (void)ring_->push(row); }  // allocates nothing
  // Ends the thread and gives all rows, in order. Once.
  [[nodiscard]] std::vector<LogRow> finish();
  // After finish(): `time_s,way,bytes`, a line a write or read, as CSV.
  [[nodiscard]] std::string& traffic() { return traffic_; }
  [[nodiscard]] std::uint64_t dropped() const { return ring_->dropped(); }

 private:
  void collect();
  void collect_traffic();
  void work();

  using Rows = device::Ring<LogRow, 4096>;
  std::unique_ptr<Rows> ring_ = std::make_unique<Rows>();
  std::function<void(int)> on_step_;
  device::Tap* tap_;
  std::string traffic_ = "time_s,way,bytes\n";
  std::string bytes_;         // of a write or read that came in parts
  double first_time_ = -1.0;  // s, wire time
  std::vector<LogRow> rows_;
  int step_ = 0;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace palpate::run
