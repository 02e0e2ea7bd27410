// The emulated hand: a mass on a damped spring whose other end goes where the person means to go.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace emulator {

using Vec3 = std::array<double, 3>;

struct Waypoint {
  double at;      // s, when it is reached
  Vec3 position;  // m
};

struct HandSettings {
  double mass = 0.15;        // kg, of hand and arm at the grip
  double stiffness = 300.0;  // N/m
  double damping = 6.0;      // N s/m
  Vec3 start = {0.0, -0.12, 0.15};
  std::vector<Waypoint> waypoints = {};
};

struct Intent {
  Vec3 position;      // m
  Vec3 velocity;      // m/s
  Vec3 acceleration;  // m/s^2
};

// Minimum jerk from waypoint to waypoint, at rest at each; the start is waypoint zero at t = 0.
[[nodiscard]] Intent intent_at(const HandSettings& settings, double t);

struct Hand {
  HandSettings settings;
  double step;                       // s
  std::array<double, 4> propagator;  // of offset and its velocity over one step, row by row
  double t = 0;                      // s
  Vec3 position{};                   // m
  Vec3 velocity{};                   // m/s
  double work = 0;                   // J, done on it by the device so far
  double most_work = 0;              // J, the greatest that ever was
  double most_energy = 0;            // J, kinetic and spring
};

[[nodiscard]] Hand make_hand(const HandSettings& settings, double step);

// One step under a constant force of the device and of whatever else it meets, N. The device's
// work is exact: force times way.
void move(Hand& hand, const Vec3& device_force, const Vec3& other_force);
// One step in which the arm is locked: it stands.
void hold(Hand& hand);
[[nodiscard]] double energy_of(const Hand& hand);  // J, kinetic and spring

}  // namespace emulator
