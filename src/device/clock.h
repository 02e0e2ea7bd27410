// Time for links and loops: the machine's monotonic clock, or a clock that the program advances;
// and real-time settings that a loop requests from the system.
#pragma once

#include <cstddef>
#include <ctime>
#include <string>

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

// Real-time settings. A text that is returned is empty on success, and otherwise a sentence for a
// warning. None of the functions throws.

// Locks all present and future memory of the program, so that it is not paged out.
[[nodiscard]] std::string lock_memory();

// Gives the calling thread priority over all ordinary threads (SCHED_FIFO, `priority` 1 to 98).
[[nodiscard]] std::string use_fifo(int priority);
void use_ordinary();  // back to SCHED_OTHER

// Writes to `bytes` of the calling thread's stack, so that they cause no page fault later.
void prefault_stack(std::size_t bytes);

}  // namespace palpate::device
