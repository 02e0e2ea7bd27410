// Flags that end running cases or prevent new ones.
#pragma once

#include <atomic>

namespace palpate::run {

struct Stop {
  const std::atomic<bool>& end_now;        // running cases end soon, as interrupted
  const std::atomic<bool>& begin_no_more;  // no case is begun; running cases go on to their end

  [[nodiscard]] bool no_more() const { return end_now.load() || begin_no_more.load(); }
};

}  // namespace palpate::run
