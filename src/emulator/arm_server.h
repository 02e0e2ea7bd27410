// The arm's service on sockets of 127.0.0.1.
#pragma once

#include <optional>
#include <string>

#include "emulator/arm.h"

namespace emulator {

struct ArmRun {
  ArmSettings settings = {};
  int port = 0;         // 0: any free port
  int events_port = 0;  // of the read-only events channel
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real time; none: until SIGINT or SIGTERM
};

// Runs the service. Prints one JSON line with the ports, and one with a summary at the end. Returns
// the exit code; throws InputError if a port cannot be opened.
int run_inverse3(const ArmRun& run);

}  // namespace emulator
