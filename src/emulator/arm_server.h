// The arm's service on sockets of 127.0.0.1, until it is told to end.
#pragma once

#include <optional>
#include <string>

#include "emulator/arm.h"

namespace emulator {

struct ArmRun {
  ArmSettings settings = {};
  int port = 0;         // 0: any that is free
  int events_port = 0;  // of the read-only events channel
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real; none: until SIGINT or SIGTERM
};

// Prints one JSON line with the ports, and one with a summary at the end. Returns the exit code;
// throws `Refused` where a port cannot be had.
int run_inverse3(const ArmRun& run);

}  // namespace emulator
