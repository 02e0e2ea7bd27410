// Absolute sleeps on CLOCK_MONOTONIC: a late wake-up does not make the next one late.
#include "device/clock.h"

#include <cerrno>
#include <cmath>
#include <ctime>

namespace palpate::device {

double wire_time() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Clock::now() const { return kind_ == Kind::monotonic ? wire_time() : stepped_; }

void Clock::sleep_until(double time) {
  if (!std::isfinite(time)) return;
  if (kind_ == Kind::stepped) {
    if (time > stepped_) stepped_ = time;
    return;
  }
  if (time <= 0.0) return;
  timespec until{};
  until.tv_sec = static_cast<time_t>(time);
  until.tv_nsec = static_cast<long>(1e9 * (time - std::floor(time)));
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palpate::device
