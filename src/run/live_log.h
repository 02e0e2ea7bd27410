// What a live loop leaves behind, row by row, taken over by another thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "device/ring.h"
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
  // `on_step` is called on the log's thread when the rows go over to another step.
  explicit LiveLog(std::function<void(int step)> on_step);
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  void push(const LogRow& row) { (void)ring_->push(row); }  // allocates nothing
  // Ends the thread and gives all rows, in order. Once.
  [[nodiscard]] std::vector<LogRow> finish();
  [[nodiscard]] std::uint64_t dropped() const { return ring_->dropped(); }

 private:
  void collect();
  void work();

  using Rows = device::Ring<LogRow, 4096>;
  std::unique_ptr<Rows> ring_ = std::make_unique<Rows>();
  std::function<void(int)> on_step_;
  std::vector<LogRow> rows_;
  int step_ = 0;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace palpate::run
