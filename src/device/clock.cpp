// Sleeps until absolute times of CLOCK_MONOTONIC, so that late wake-ups do not add up.
#include "device/clock.h"

#include <cerrno>
#include <cmath>

namespace palpate::device {

double wire_time() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

timespec timespec_of(double seconds) {
  timespec time{};
  time.tv_sec = static_cast<time_t>(seconds);
  time.tv_nsec = static_cast<long>(1e9 * (seconds - std::floor(seconds)));
  return time;
}

double Clock::now() const { return kind_ == Kind::monotonic ? wire_time() : stepped_; }

void Clock::sleep_until(double time) {
  if (!std::isfinite(time)) return;
  if (kind_ == Kind::stepped) {
    if (time > stepped_) stepped_ = time;
    return;
  }
  if (time <= 0.0) return;
  const timespec until = timespec_of(time);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palpate::device
