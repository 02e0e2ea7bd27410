// A limit of time for a run.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace palpate::chart {

// A flag that a second thread sets when `outer` is set or after `limit` seconds.
class Watch {
 public:
  using Clock = std::chrono::steady_clock;

  Watch(const std::atomic<bool>& outer, double limit)
      : thread_([this, &outer, limit] {
          const auto end = Clock::now() + std::chrono::duration<double>(limit);
          std::unique_lock lock(mutex_);
          while (!over_ && !flag_) {
            wake_.wait_for(lock, std::chrono::milliseconds(20));
            if (outer.load() || Clock::now() >= end) flag_ = true;
          }
        }) {}
  ~Watch() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    wake_.notify_all();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  [[nodiscard]] const std::atomic<bool>& flag() const { return flag_; }

 private:
  std::atomic<bool> flag_ = false;
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::jthread thread_;
};

}  // namespace palpate::chart
