// The stand on a pseudo-terminal.
#pragma once

#include "emulator/pty_loop.h"

namespace emulator {

struct Mark10Run {
  Mark10Settings settings = {};  // its clock, tick and rate are those of `line`
  PtyRun line = {};
};

// Runs the stand. Returns the exit code; throws InputError.
int run_mark10(const Mark10Run& run);

}  // namespace emulator
