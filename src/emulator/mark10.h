// The stand on its serial line, with clocks and faults; bytes are texts, without a port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/serial_device.h"
#include "emulator/stand.h"

namespace emulator {

struct Mark10Settings {
  StandSettings stand = {};
  std::vector<Fault> faults = {};
  Clock clock = Clock::real;
  Nanoseconds tick = 20'000'000;  // lockstep: requests are answered at multiples of it
  // Lockstep: the readings in a reply are older than the reply, by `latency` and a random time of
  // up to `jitter`.
  Nanoseconds latency = 0;
  Nanoseconds jitter = 0;
  int baud = 115200;
};

class Mark10 : public SerialDevice {
 public:
  Mark10(const Mark10Settings& settings, Log& log);

  void pass(Nanoseconds now) override;
  void take(char byte, Rate rate_of_other_side) override;

  [[nodiscard]] const Stand& stand() const { return stand_; }
  [[nodiscard]] std::int64_t requests() const { return requests_; }
  [[nodiscard]] std::string summary() const override;

 private:
  void go_to(Nanoseconds time, std::int64_t requests);
  void advance_to(Nanoseconds time) override;
  void begin(const Fault& fault) override;
  void log_row(const char* kind, const std::string& text) override;
  [[nodiscard]] Nanoseconds age_of_reading();
  [[nodiscard]] std::string reply_to(char byte);

  Mark10Settings settings_;
  Stand stand_;
  Random delays_;
  std::int64_t requests_ = 0;
  std::string command_ = {};  // bytes of an incomplete command, for the log
  std::string frozen_ = {};   // the reply that the fault `freeze` repeats
};

}  // namespace emulator
