// What a long computation is at, in words, for a line of progress.
#pragma once

#include <string>

namespace palpate {

// Thread-safe; doing() is what any thread set last.
void set_doing(std::string text);
[[nodiscard]] std::string doing();

}  // namespace palpate
