// Ctrl-C and SIGTERM as a flag.
#pragma once

#include <atomic>
#include <vector>

namespace palpate::cli {

// From now on Ctrl-C and SIGTERM end the program at once with exit code `code`, unless ignored.
void end_at_interrupts(int code);

// From now on the first signal among Ctrl-C, SIGTERM and `more` sets the returned flag, and a
// second one ends the program at once with exit code `code`. Ignored signals (nohup) stay ignored.
[[nodiscard]] const std::atomic<bool>& listen_for_interrupts(int code,
                                                             const std::vector<int>& more = {});

}  // namespace palpate::cli
