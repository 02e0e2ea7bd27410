// Time for links and loops: the machine's monotonic clock, or one that only steps when told.
#pragma once

namespace palpate::device {

class Clock {
 public:
  enum class Kind { monotonic, stepped };
  explicit Clock(Kind kind) : kind_(kind) {}

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] double now() const;  // s, from an arbitrary start; a stepped clock starts at 0

  // Sleeps till then, or, for a stepped clock, makes it be then; never goes back.
  void sleep_until(double time);

 private:
  Kind kind_;
  double stepped_ = 0.0;  // s
};

// The machine's monotonic clock in s: what waiting for a wire is measured by, whatever the Clock.
[[nodiscard]] double wire_time();

}  // namespace palpate::device
