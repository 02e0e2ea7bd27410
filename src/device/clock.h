// Time for links and loops: the machine's monotonic clock, or a clock that the program advances.
#pragma once

#include <ctime>

namespace palpate::device {

class Clock {
 public:
  enum class Kind { monotonic, stepped };
  explicit Clock(Kind kind) : kind_(kind) {}

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] double now() const;  // s, from an arbitrary start; a stepped clock starts at 0

  // Sleeps until `time` (s), or sets a stepped clock to `time`. The clock never goes back.
  void sleep_until(double time);

 private:
  Kind kind_;
  double stepped_ = 0.0;  // s
};

// The machine's monotonic clock in s. Timeouts of the wire are measured by it, with either Clock.
[[nodiscard]] double wire_time();

// A time of `seconds` (s, at least 0), as the system calls take it.
[[nodiscard]] timespec timespec_of(double seconds);

}  // namespace palpate::device
