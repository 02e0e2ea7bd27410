// The emulator's command line.
#pragma once

namespace emulator {

// Runs what the arguments say. Returns 0, 1 for a fault of its own, 2 for refused input.
int program(int argc, const char* const* argv);

}  // namespace emulator
