// What a long computation is at, in words, for a line of progress.
#pragma once

#include <string>

namespace palpate {

// Of several threads the last one to say something is heard. Thread-safe.
void set_doing(std::string text);
[[nodiscard]] std::string doing();

}  // namespace palpate
