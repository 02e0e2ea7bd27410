// Ctrl-C and SIGTERM as a flag that work looks at.
#pragma once

#include <atomic>
#include <vector>

namespace palpate::cli {

// From now on the first signal, of Ctrl-C, SIGTERM and `more`, sets the flag that is returned, and
// a second one ends the program at once with `code`. A signal that is ignored, as under nohup,
// stays so.
[[nodiscard]] const std::atomic<bool>& listen_for_interrupts(int code,
                                                             const std::vector<int>& more = {});

}  // namespace palpate::cli
