// The stand on its serial line, with clocks and faults; bytes are texts, without a port.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/faults.h"
#include "emulator/log.h"
#include "emulator/stand.h"

namespace emulator {

// The machine's monotonic clock, or `--clock virtual`: only bytes and requests advance the time.
enum class Clock { real, lockstep };

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

class Mark10 {
 public:
  Mark10(const Mark10Settings& settings, Log& log);

  // The time of one byte on the line: ten bits (start, eight, stop).
  [[nodiscard]] Nanoseconds byte_time() const;

  // Real clock: advances to `now` without a byte.
  void pass(Nanoseconds now);
  // Processes a byte that arrived; it is garbled if the client's port has another baud rate.
  enum class Rate { same, other };
  void take(char byte, Rate rate_of_other_side);
  // Returns the bytes to be sent now, in order; empty while the fault `stall` lasts.
  [[nodiscard]] std::string give();

  [[nodiscard]] bool unplugged() const { return unplugged_; }
  // When the port comes back after `unplug`; none if never.
  [[nodiscard]] std::optional<Nanoseconds> plugged_again_at() const { return again_; }
  void plug_in();

  [[nodiscard]] Nanoseconds now() const { return now_; }
  [[nodiscard]] const Stand& stand() const { return stand_; }
  [[nodiscard]] std::int64_t requests() const { return requests_; }
  void log_state();
  [[nodiscard]] std::string summary() const;  // a JSON object

 private:
  void go_to(Nanoseconds time);
  void go_to(Nanoseconds time, std::int64_t requests);
  [[nodiscard]] Nanoseconds age_of_reading();
  void begin_faults(std::int64_t requests);
  void apply(const Fault& fault);
  [[nodiscard]] std::string spoilt(std::string reply);
  [[nodiscard]] std::string reply_to(char byte);
  void send(const std::string& bytes);
  void log_row(const char* kind, const std::string& text);

  Mark10Settings settings_;
  Stand stand_;
  Random delays_;
  Faults faults_;
  Log* log_;
  Nanoseconds now_ = 0;
  std::int64_t requests_ = 0;
  std::string out_ = {};
  std::string command_ = {};  // bytes of an incomplete command, for the log
  std::string frozen_ = {};   // the reply that the fault `freeze` repeats
  bool unplugged_ = false;
  std::optional<Nanoseconds> again_ = {};
};

}  // namespace emulator
