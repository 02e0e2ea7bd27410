// What a long computation is at, in words, for a line of progress.
#pragma once

#include <cstddef>
#include <string>

namespace palpate {

struct Doing {
  std::string text;
  std::size_t done = 0, all = 0;  // steps; 0 of 0 where they are not counted
};

// Thread-safe; doing() is what any thread set last.
void set_doing(Doing now);
[[nodiscard]] Doing doing();

}  // namespace palpate
