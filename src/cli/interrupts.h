// SIGINT and SIGTERM as a flag that long work looks at.
#pragma once

#include <atomic>

namespace palpate::cli {

// Set once either signal has come, after listen_for_interrupts().
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

// From here on a first signal sets the flag, and a second one ends the program with exit code 130.
// A signal that is ignored, as under nohup, stays so.
void listen_for_interrupts();

}  // namespace palpate::cli
