// Lets a flag end a long computation from within.
#pragma once

#include <atomic>
#include <exception>
#include <utility>

namespace palpate {

// A computation that was ended because its thread's flag was set.
class Stopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

// While this exists, end_if_stopped() on its thread throws Stopped once `stop` is set. Iterations
// that can take seconds call it; without a scope they go on to their end.
class StopScope {
 public:
  explicit StopScope(const std::atomic<bool>& stop) : before_(std::exchange(flag(), &stop)) {}
  ~StopScope() { flag() = before_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  static void end_if_stopped() {
    if (flag() != nullptr && flag()->load(std::memory_order_relaxed)) throw Stopped();
  }

 private:
  static const std::atomic<bool>*& flag() {
    thread_local const std::atomic<bool>* flag = nullptr;
    return flag;
  }

  const std::atomic<bool>* before_;
};

}  // namespace palpate
