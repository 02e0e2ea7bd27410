// Time steps of the crosshead: it accelerates, cruises, and brakes before the end of its range.
#include "emulator/crosshead.h"

#include <algorithm>
#include <cmath>

namespace emulator {
namespace {

// m, the position at which a motion ends: the limit switch, or a travel limit before it.
double end_of_way(const Crosshead& crosshead, int direction) {
  const CrossheadSettings& s = crosshead.settings;
  if (crosshead.mode == Mode::manual) return direction > 0 ? s.upper_end : s.lower_end;
  return direction > 0 ? std::min(s.upper_end, crosshead.upper_limit)
                       : std::max(s.lower_end, crosshead.lower_limit);
}

void arrive(Crosshead& crosshead, double end) {
  crosshead.position = end;
  crosshead.velocity = 0.0;
  crosshead.at_end = crosshead.direction;
  ++crosshead.half_cycles;
  const bool again =
      crosshead.mode == Mode::cycle && crosshead.half_cycles < 2 * crosshead.cycles_set;
  crosshead.direction = again ? -crosshead.direction : 0;
}

}  // namespace

void send_off(Crosshead& crosshead, int direction) {
  const double left = (end_of_way(crosshead, direction) - crosshead.position) * direction;
  crosshead.half_cycles = 0;
  if (direction != crosshead.pressed) crosshead.pressed = 0;
  if (left <= 0.0 || crosshead.pressed != 0) {
    crosshead.at_end = direction;
    halt(crosshead);
    return;
  }
  crosshead.direction = direction;
}

void halt(Crosshead& crosshead) { crosshead.direction = 0; }

bool moves(const Crosshead& crosshead) {
  return crosshead.direction != 0 || crosshead.velocity != 0.0;
}

// |v| changes by at most a dt, and the distance left after the step must suffice for braking:
//   v1^2 / (2 a) <= d - (v + v1) dt / 2   =>   v1 = -a dt/2 + sqrt((a dt/2)^2 + 2 a d - a dt v)
// The position moves with the mean of both velocities, which is exact for constant acceleration.
void step(Crosshead& crosshead, double dt) {
  if (!moves(crosshead)) return;
  const double most = crosshead.settings.acceleration * dt;
  const int way = crosshead.direction;
  double wanted = 0.0;
  if (way != 0) {
    const double left = (end_of_way(crosshead, way) - crosshead.position) * way;
    const double half = 0.5 * most;  // a dt / 2
    const double square = half * half + 2.0 * crosshead.settings.acceleration * left -
                          most * crosshead.velocity * way;
    const double braking = square > 0.0 ? std::max(0.0, std::sqrt(square) - half) : 0.0;
    wanted = way * std::min(crosshead.speed, braking);
  }
  const double before = crosshead.velocity;
  const double after = before + std::clamp(wanted - before, -most, most);
  crosshead.position += 0.5 * (before + after) * dt;
  crosshead.velocity = after;
  if (after != 0.0) crosshead.at_end = 0;
  // A rest of less than a few a dt^2, left by rounding or by a partial step, counts as arrival.
  const double near = 8.0 * most * dt;
  if (way != 0) {
    const double stop = end_of_way(crosshead, way);
    const double left = (stop - crosshead.position) * way;
    if (after * way >= 0.0 && left <= 0.5 * most * dt) {
      if (left >= -near)
        arrive(crosshead, stop);
      else
        halt(crosshead);  // a limit was set that it has already passed
    }
  }
  for (const int side : {-1, 1}) {  // a limit switch stops every motion at once
    const double end = side > 0 ? crosshead.settings.upper_end : crosshead.settings.lower_end;
    if ((end - crosshead.position) * side >= 0.0) continue;
    crosshead.position = end;
    crosshead.velocity = 0.0;
    crosshead.direction = 0;
    crosshead.at_end = side;
  }
}

}  // namespace emulator
