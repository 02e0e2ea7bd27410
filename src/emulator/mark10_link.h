// The stand on a pseudo-terminal, until it is told to end.
#pragma once

#include <optional>
#include <string>

#include "emulator/mark10.h"

namespace emulator {

struct Mark10Run {
  Mark10Settings settings = {};
  std::string link = {};
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real; none: until SIGINT or SIGTERM
};

// Prints one JSON line with the port when it is there, again when it comes back after `unplug`, and
// one with a summary at the end. Returns the exit code; throws `Refused`.
int run_mark10(const Mark10Run& run);

}  // namespace emulator
