// What a long computation is at, in words, for a line of progress.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace palpate {

struct Doing {
  std::string text;
  std::size_t done = 0, all = 0;  // steps; 0 of 0 where they are not counted
};

// What any thread set last; sets `next` where there is one. Thread-safe.
inline Doing doing(std::optional<Doing> next = std::nullopt) {
  static std::mutex mutex;
  static Doing now;
  const std::scoped_lock lock(mutex);
  if (next) now = std::move(*next);
  return now;
}
inline void set_doing(Doing next) { (void)doing(std::move(next)); }

}  // namespace palpate
