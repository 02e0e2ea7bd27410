// What a loop asks of the system before it starts. Each call gives an empty text where it was
// granted, and otherwise a sentence for a warning and for the record; none of them throws.
#pragma once

#include <cstddef>
#include <string>

namespace palpate::device {

// Keeps all memory, present and future, from being paged out.
[[nodiscard]] std::string lock_memory();

// Runs the calling thread before all ordinary ones, at `priority` from 1 to 98.
[[nodiscard]] std::string use_fifo(int priority);
void use_ordinary();  // and after the others again

// Touches `bytes` of the calling thread's stack, so that no page of it is missing later.
void prefault_stack(std::size_t bytes);

}  // namespace palpate::device
