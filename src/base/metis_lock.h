// METIS uses rand(), which all threads share: without this lock its orders would depend on them.
#pragma once

#include <mutex>

namespace palpate {

inline std::mutex& metis_lock() {
  static std::mutex one_at_a_time;
  return one_at_a_time;
}

}  // namespace palpate
