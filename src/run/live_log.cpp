// One thread pushes, this one pops.
#include "run/live_log.h"

#include <chrono>
#include <utility>

namespace palpate::run {

LiveLog::LiveLog(std::function<void(int)> on_step) : on_step_(std::move(on_step)) {
  thread_ = std::thread([this] { work(); });
}

LiveLog::~LiveLog() {
  over_ = true;
  if (thread_.joinable()) thread_.join();
}

void LiveLog::collect() {
  LogRow row;
  while (ring_->pop(row)) {
    rows_.push_back(row);
    if (row.contact.step != step_) on_step_(step_ = row.contact.step);
  }
}

void LiveLog::work() {
  constexpr auto pause = std::chrono::milliseconds(5);
  while (!over_) {
    collect();
    std::this_thread::sleep_for(pause);
  }
}

std::vector<LogRow> LiveLog::finish() {
  over_ = true;
  thread_.join();
  collect();
  return std::move(rows_);
}

}  // namespace palpate::run
