// Sleeps until absolute times of CLOCK_MONOTONIC, so that late wake-ups do not add up. The system's
// limits of locked memory and priority are in /etc/security/limits.d.
#include "device/clock.h"

#include <alloca.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

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

std::string lock_memory() {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  const int error = errno;
  return std::string("memory is not locked (") + std::strerror(error) +
         "), so a page fault may delay a frame; raise `memlock` in /etc/security/limits.d";
}

std::string use_fifo(int priority) {
  sched_param param{};
  param.sched_priority = std::clamp(priority, 1, 98);
  const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &param);
  if (error == 0) return {};
  return std::string("the loop does not run before other programs (SCHED_FIFO: ") +
         std::strerror(error) +
         "), so frames may be late; raise `rtprio` in /etc/security/limits.d";
}

void use_ordinary() {
  const sched_param param{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &param);
}

void prefault_stack(std::size_t bytes) {
  constexpr std::size_t page = 4096;
  auto* stack = static_cast<volatile char*>(alloca(bytes));
  for (std::size_t at = 0; at < bytes; at += page) stack[at] = 0;
}

}  // namespace palpate::device
