// Lets a flag or a limit of time end a long computation from within.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <utility>

namespace palpate {

// A computation that was ended because its thread's flag was set or its time was over.
class Stopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

// While this exists, end_if_stopped() on its thread throws Stopped once the flag is set. Iterations
// that can take seconds call it; without a scope they go on to their end.
class StopScope {
 public:
  struct Limits {
    const std::atomic<bool>* flag = nullptr;
    std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max();

    [[nodiscard]] bool reached() const {
      return (flag != nullptr && flag->load(std::memory_order_relaxed)) ||
             (end != std::chrono::steady_clock::time_point::max() &&
              std::chrono::steady_clock::now() >= end);
    }
  };

  explicit StopScope(const std::atomic<bool>& flag) : StopScope(Limits{.flag = &flag}) {}
  // With what is in force already, at most so many s from now on.
  explicit StopScope(double seconds) : StopScope(within(seconds)) {}
  // With the limits() of another thread.
  explicit StopScope(const Limits& limits) : before_(std::exchange(current(), limits)) {}
  ~StopScope() { current() = before_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  [[nodiscard]] static Limits limits() { return current(); }
  [[nodiscard]] static bool stopped() { return current().reached(); }
  static void end_if_stopped() {
    if (stopped()) throw Stopped();
  }

 private:
  static Limits& current() {
    thread_local Limits limits;
    return limits;
  }

  static Limits within(double seconds) {
    using Clock = std::chrono::steady_clock;
    Limits limits = current();
    limits.end = std::min(limits.end, Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                         std::chrono::duration<double>(seconds)));
    return limits;
  }

  Limits before_;
};

}  // namespace palpate
