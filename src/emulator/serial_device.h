// A device on a serial line, with its clock, its bytes and faults, and the loop that runs it on a
// pseudo-terminal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/faults.h"
#include "emulator/files.h"

namespace emulator {

using Nanoseconds = std::int64_t;  // since the emulator's start

[[nodiscard]] constexpr double seconds(Nanoseconds time) {
  return static_cast<double>(time) * 1e-9;
}
[[nodiscard]] constexpr Nanoseconds nanoseconds(double time) {
  return static_cast<Nanoseconds>(time * 1e9 + (time < 0.0 ? -0.5 : 0.5));
}

inline constexpr std::int64_t rate = 7000;  // gauge samples and mechanical steps per second

// The machine's monotonic clock, or `--clock virtual`: only bytes and requests advance the time.
enum class Clock { real, lockstep };

class SerialDevice {
 public:
  virtual ~SerialDevice() = default;
  SerialDevice(const SerialDevice&) = delete;
  SerialDevice& operator=(const SerialDevice&) = delete;

  // The time of one byte on the line: ten bits (start, eight, stop).
  [[nodiscard]] Nanoseconds byte_time() const;
  // Returns the bytes to be sent now, in order; empty while the fault `stall` lasts.
  [[nodiscard]] std::string give();

  // Advances to `now` without a byte.
  virtual void pass(Nanoseconds now) = 0;
  // Processes a byte that arrived; it is garbled if the client's port has another baud rate.
  enum class Rate { same, other };
  virtual void take(char byte, Rate rate_of_other_side) = 0;
  void hears_at(Rate rate_of_other_side) { other_rate_ = rate_of_other_side == Rate::other; }

  [[nodiscard]] bool unplugged() const { return unplugged_; }
  // When the port comes back after `unplug`; none if never.
  [[nodiscard]] std::optional<Nanoseconds> plugged_again_at() const { return again_; }
  void plug_in();

  [[nodiscard]] Nanoseconds now() const { return now_; }
  [[nodiscard]] virtual std::string summary() const = 0;  // a JSON object
  void log_state() { log_row("state", ""); }

 protected:
  SerialDevice(const std::vector<Fault>& faults, int baud, Log& log)
      : faults_(faults), baud_(baud), log_(&log) {}

  // Advances to `time`. Faults with `at` begin exactly at their time, however long the advance is;
  // `messages` counts those so far, or is -1 where none may begin by their number.
  void go_to(Nanoseconds time, std::int64_t messages);
  virtual void advance_to(Nanoseconds time) = 0;  // and sets now_
  virtual void begin(const Fault& fault) = 0;     // all but `unplug`
  virtual void log_row(const char* kind, const std::string& text) = 0;

  // A reply as faults change it; garbage and a cut leave the last `end` bytes as they are.
  [[nodiscard]] std::string spoilt(std::string reply, const std::string& another, std::size_t end);
  void send(const std::string& bytes);
  // A byte at a wrong rate: never a printable one, so never a command.
  [[nodiscard]] static char noise(char byte);

  Faults faults_;
  int baud_;
  Log* log_;
  Nanoseconds now_ = 0;
  std::string out_ = {};
  bool other_rate_ = false;  // the client's port has another baud rate

 private:
  bool unplugged_ = false;
  std::optional<Nanoseconds> again_ = {};
};

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
