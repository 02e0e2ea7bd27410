// Waiting for what happens instead of for the clock.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace palpate::test {

// How long a test waits for what must happen: far longer than any machine takes, however busy, so
// that only what never happens fails.
inline constexpr std::chrono::seconds patience{60};

// Looks again and again; false where it is not there before patience ends.
inline bool seen(const std::function<bool()>& there) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!there()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace palpate::test
