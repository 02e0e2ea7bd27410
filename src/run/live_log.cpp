// One thread pushes, this one pops.
#include "run/live_log.h"

#include <chrono>
#include <utility>

#include "base/text.h"

namespace palpate::run {

LiveLog::LiveLog(std::function<void(int)> on_step, device::Tap* tap)
    : on_step_(std::move(on_step)), tap_(tap) {
  thread_ = std::thread([this] { work(); });
}

LiveLog::~LiveLog() {
  over_ = true;
  if (thread_.joinable()) thread_.join();
}

void LiveLog::collect_traffic() {
  device::Tap::Part part;
  while (tap_ != nullptr && tap_->take(part)) {
    if (first_time_ < 0.0) first_time_ = part.time;
    bytes_.append(part.bytes.data(), part.size);
    if (!part.last) continue;
    traffic_ += number_text(part.time - first_time_) +
                (part.way == device::Tap::Way::sent ? ",sent," : ",received,") +
                device::tapped_text(bytes_) + "\n";
    bytes_.clear();
  }
}

void LiveLog::collect() {
  collect_traffic();
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
