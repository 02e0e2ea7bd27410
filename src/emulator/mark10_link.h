// The stand on a pseudo-terminal.
#pragma once

#include <optional>
#include <string>

#include "emulator/mark10.h"

namespace emulator {

struct Mark10Run {
  Mark10Settings settings = {};
  std::string link = {};
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real time; none: until SIGINT or SIGTERM
};

// Runs the stand. Prints one JSON line with the port when the port is ready, and again after an
// `unplug`, and one with a summary at the end. Returns the exit code; throws InputError.
int run_mark10(const Mark10Run& run);

}  // namespace emulator
