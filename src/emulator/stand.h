// The motorised stand with its gauge, pressing the tissue: commands, replies and motion in time, on
// its serial line, with clocks and faults; bytes are texts, without a port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/gauge.h"
#include "emulator/serial_device.h"
#include "emulator/tissue.h"

namespace emulator {

enum class Mode { limit, manual, cycle };  // commands `l`, `m`, `c`

struct CrossheadSettings {
  double acceleration = 0.2;        // m/s^2, of every change of speed
  double slowest = 0.5e-3 / 60.0;   // m/s
  double fastest = 1100e-3 / 60.0;  // m/s
  double lower_end = -0.15;         // m, the lower limit switch
  double upper_end = 0.15;          // m, the upper one
};

struct Crosshead {
  CrossheadSettings settings = {};
  Mode mode = Mode::manual;
  double position = 0;          // m, upwards
  double velocity = 0;          // m/s
  double speed = 60e-3 / 60.0;  // m/s, of the next motion
  int direction = 0;            // -1 down, 0 stopped or stopping, 1 up
  double lower_limit = -0.15;   // m, active in limit and cycle mode
  double upper_limit = 0.15;    // m
  std::int64_t cycles_set = 1;
  std::int64_t half_cycles = 0;  // completed strokes
  int at_end = 0;                // -1 at the lower end of its range, 1 at the upper end
  int pressed = 0;               // fault limit_switch: the direction that is blocked, or 0
};

// Starts a motion. If the crosshead is already at that end, or blocked, it stops instead.
void send_off(Crosshead& crosshead, int direction);
void halt(Crosshead& crosshead);  // brakes with the acceleration limit
void step(Crosshead& crosshead, double dt);
[[nodiscard]] bool moves(const Crosshead& crosshead);

// The layout of the reply to `p`: the guide lists its codes only.
enum class StatusLayout { compact, spaced, none };   // "SLUL", "S L UL", no reply
enum class PairOrder { force_first, travel_first };  // of the lines of `n`

struct StandSettings {
  CrossheadSettings crosshead = {};
  GaugeSettings gauge = {};
  TissueSettings tissue = {};
  double speed = 60e-3 / 60.0;         // m/s, after switching on
  double travel_resolution = 0.02e-3;  // m
  bool pc_control = true;              // without this option the line cannot move the stand
  bool travel_display = true;          // without it the stand sends the force only
  PairOrder order = PairOrder::force_first;
  StatusLayout status = StatusLayout::compact;
  ListStyle list = ListStyle::ipol;
  OverloadReply overload = OverloadReply::text;
  std::uint64_t seed = 1;
};

// The tables [stand] and [gauge].
void fields(palpate::FieldVisitor& visitor, StandSettings& settings);
// Reads these tables; keys that the file does not name keep their values. Throws InputError.
void read_stand(const std::string& path, StandSettings& settings);

struct Stand {
  StandSettings settings;
  Crosshead crosshead;
  Gauge gauge;
  Gcl2 language;
  Tissue tissue;
  std::int64_t steps = 0;  // of 1/7000 s
  double zero = 0;         // m, the position with zero travel
  bool inches = false;
  bool to_gauge = false;  // between `/` and `\`
  std::string line = {};  // bytes of an incomplete line to the gauge
  char setter = 0;        // `e`, `f`, `g` or `h` while its digits arrive
  std::string digits = {};
  double programmed_speed = 0;  // m/s, selected by `o`
  Nanoseconds next_output = 0;  // time of the next automatic reading
  std::string unsolicited = {};
  double deepest = 0;         // m, so far
  double greatest_force = 0;  // N, so far
};

[[nodiscard]] Stand make_stand(const StandSettings& settings);

// Switches the stand off and on: settings, zeros and limits are lost, the crosshead does not move.
void switch_on_again(Stand& stand);

// Moves, presses and samples up to a time. Automatic readings are appended to `unsolicited`.
void advance(Stand& stand, Nanoseconds time);

// Whether this byte completes a request, which may have a reply.
[[nodiscard]] bool ends_request(const Stand& stand, char byte);
// Whether no command is incomplete.
[[nodiscard]] bool between_commands(const Stand& stand);

// Processes one byte now. Returns the reply, which is empty for most bytes.
[[nodiscard]] std::string receive(Stand& stand, char byte);

[[nodiscard]] double travel(const Stand& stand);  // m, true travel from the zero
[[nodiscard]] double depth(const Stand& stand);   // m, true depth below the surface

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
