// Times of a sweep's parts.
#pragma once

#include <chrono>

namespace palpate::sweep {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {  // s
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace palpate::sweep
