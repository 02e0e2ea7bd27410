// Real-time settings that a loop requests from the system before it starts. A text that is returned
// is empty on success, and otherwise a sentence for a warning. None of the functions throws.
#pragma once

#include <cstddef>
#include <string>

namespace palpate::device {

// Locks all present and future memory of the program, so that it is not paged out.
[[nodiscard]] std::string lock_memory();

// Gives the calling thread priority over all ordinary threads (SCHED_FIFO, `priority` 1 to 98).
[[nodiscard]] std::string use_fifo(int priority);
void use_ordinary();  // back to SCHED_OTHER

// Writes to `bytes` of the calling thread's stack, so that they cause no page fault later.
void prefault_stack(std::size_t bytes);

}  // namespace palpate::device
