// The stand's moving part: constant speed behind an acceleration limit, ends that stop it.
#pragma once

#include <cstdint>

namespace emulator {

enum class Mode { limit, manual, cycle };  // the stand's `l`, `m`, `c`

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
  double speed = 60e-3 / 60.0;  // m/s, what it goes to when it is sent off
  int direction = 0;            // -1 down, 0 stopped or stopping, 1 up
  double lower_limit = -0.15;   // m, obeyed in limit and cycle mode
  double upper_limit = 0.15;
  std::int64_t cycles_set = 1;
  std::int64_t half_cycles = 0;  // strokes that were finished
  int at_end = 0;                // -1 at the lower end of its way, 1 at the upper
  int pressed = 0;               // the way a switch blocks though it is not at its end: a fault
};

// Sends it off. Nothing happens where it already stands at that end.
void send_off(Crosshead& crosshead, int direction);
void halt(Crosshead& crosshead);  // brakes with the acceleration limit
void step(Crosshead& crosshead, double dt);
[[nodiscard]] bool moves(const Crosshead& crosshead);

}  // namespace emulator
