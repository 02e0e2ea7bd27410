// How cases that run are asked to end.
#pragma once

#include <atomic>

namespace palpate::run {

struct Stop {
  const std::atomic<bool>& end_now;        // at the next row; such a case counts as not run
  const std::atomic<bool>& begin_no_more;  // cases that run go on to their end

  [[nodiscard]] bool no_more() const { return end_now.load() || begin_no_more.load(); }
};

}  // namespace palpate::run
