// Locked memory, SCHED_FIFO and the stack. The system's limits are in /etc/security/limits.d.
#include "device/realtime.h"

#include <alloca.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace palpate::device {

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
