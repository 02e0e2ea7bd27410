// The emulated hand: a mass on a damped spring whose other end follows an intended path.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace emulator {

using Vec3 = std::array<double, 3>;

struct Waypoint {
  double at;      // s, time of arrival
  Vec3 position;  // m
};

struct HandSettings {
  double mass = 0.15;        // kg, of hand and arm at the grip
  double stiffness = 300.0;  // N/m
  double damping = 6.0;      // N s/m
  Vec3 start = {0.0, -0.12, 0.15};
  std::vector<Waypoint> waypoints = {};
};

// The other end of the spring.
struct Intent {
  Vec3 position;      // m
  Vec3 velocity;      // m/s
  Vec3 acceleration;  // m/s^2
};

// The minimum-jerk path, with rest at each waypoint. It begins at `start` at t = 0.
[[nodiscard]] Intent intent_at(const HandSettings& settings, double t);

struct Hand {
  HandSettings settings;
  double step;                       // s
  std::array<double, 4> propagator;  // 2 x 2 by rows: offset and its velocity after one step
  double t = 0;                      // s
  Vec3 position{};                   // m
  Vec3 velocity{};                   // m/s
  double work = 0;                   // J, done on the hand by the device so far
  double most_work = 0;              // J, the largest value of `work` so far
  double most_energy = 0;            // J, the largest value of energy_of() so far
};

[[nodiscard]] Hand make_hand(const HandSettings& settings, double step);

// Advances by one step under constant forces (N) of the device and of other bodies. The work of
// the device is exact: force times displacement.
void move(Hand& hand, const Vec3& device_force, const Vec3& other_force);
void hold(Hand& hand);  // advances by one step in which the arm is locked and does not move
[[nodiscard]] double energy_of(const Hand& hand);  // J, kinetic and spring

}  // namespace emulator
