// The stand's crosshead: constant speed, limited acceleration, travel limits and limit switches.
#pragma once

#include <cstdint>

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

}  // namespace emulator
