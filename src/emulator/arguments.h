// The emulator's command line.
#pragma once

namespace emulator {

// Runs the emulator with these arguments. Returns the exit code: 0, 2 if an argument or an input
// file is refused, 1 for any other error.
int program(int argc, const char* const* argv);

}  // namespace emulator
