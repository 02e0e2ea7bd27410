// The processor time of this process and of the child processes that have ended.
#pragma once

#include <sys/resource.h>

namespace palpate {

// s, in user and system mode.
[[nodiscard]] inline double processor_seconds() {
  double sum = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    ::getrusage(who, &usage);
    for (const timeval& part : {usage.ru_utime, usage.ru_stime})
      sum += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  }
  return sum;
}

}  // namespace palpate
