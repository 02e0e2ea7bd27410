// The loop of a device on a pseudo-terminal: bytes that arrive, the passage of time, and replies at
// the line's rate.
#pragma once

#include <optional>
#include <string>

#include "emulator/serial_device.h"

namespace emulator {

struct PtyRun {
  std::string link = {};
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real time; none: until SIGINT or SIGTERM
  int baud = 115200;
  Clock clock = Clock::real;
  Nanoseconds tick = 20'000'000;  // of a virtual clock
};

// Prints one JSON line with the port when the port is ready, and again after an `unplug`, and one
// with the device's summary() at the end. Returns the exit code. Throws InputError if no port can
// be opened, the rate is unknown, or `link` is another file.
int run_on_pty(const PtyRun& run, SerialDevice& device);

}  // namespace emulator
