// Safety rules between a link and its commands. Each rule is a small state machine that receives
// the time as an argument. The rules use forces, positions and times only, and no tissue model.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/vec3.h"
#include "device/sample.h"

namespace palpate::device {

// The reason why commands are no longer allowed. The first reason is kept until the end of the run.
enum class Trip : std::uint8_t {
  none,
  by_hand,        // disarmed by the program or the person
  link_lost,      // hung up, or silent for longer than allowed
  inside_tissue,  // a start was requested while the finger was in the tissue
  brake,          // the device's own safety has acted
  force_ceiling,  // a stand's force is above the allowed one
  travel,         // a stand is beyond its travel limits
  jump,           // a stand's position changed faster than a stand can move
  overload,       // the force is beyond what the gauge can measure
  not_verified,   // a limit or a stop was not confirmed
};
[[nodiscard]] std::string_view trip_text(Trip trip);  // a clause

// A device is armed only on request, and never again after a trip.
class Arming {
 public:
  bool arm();  // false after a trip
  void trip(Trip why);
  [[nodiscard]] bool armed() const { return armed_; }
  [[nodiscard]] Trip tripped() const { return trip_; }

 private:
  bool armed_ = false;
  Trip trip_ = Trip::none;
};

// Returns zero if any component is not finite, and `force` otherwise.
[[nodiscard]] Vec3 finite_or_zero(const Vec3& force);

// Returns `force` with its norm limited to `most` (N) and its direction kept.
[[nodiscard]] Vec3 clamped_norm(const Vec3& force, double most);

// Limits the rate of change of a force vector.
class SlewLimit {
 public:
  // Moves the force towards `wanted` (N) for `dt` (s), with at most `rate` (N/s), and returns it.
  Vec3 step(const Vec3& wanted, double dt, double rate);
  void drop() { last_ = Vec3::Zero(); }  // sets the force to zero at once
  [[nodiscard]] const Vec3& last() const { return last_; }

 private:
  Vec3 last_ = Vec3::Zero();
};

// A gain that rises from 0 to 1 during `time` (s) after a start; a start in tissue is refused.
class StartRamp {
 public:
  explicit StartRamp(double time) : time_(time) {}
  // Starts at `now` (s). `depth` (m) is above 0 inside the tissue; there, and if it is NaN, the
  // ramp does not start and the result is false.
  bool start(double now, double depth);
  [[nodiscard]] double gain(double now) const;
  [[nodiscard]] bool started() const { return started_; }

 private:
  double time_;
  double begin_ = 0.0;
  bool started_ = false;
};

// A gain that falls when no new samples come.
struct StaleRule {
  double stale_after = 3e-3;  // s without a new sample
  double lost_after = 0.1;    // s without a new sample
  double fall = 0.05;         // s, in which the gain falls from 1 to 0
  double rise = 0.5;          // s, in which it rises from 0 to 1 when samples come again
};
class Staleness {
 public:
  enum class State { fresh, stale, lost };
  explicit Staleness(const StaleRule& rule) : rule_(rule) {}
  // Called in every frame, at `now` (s), with the arrival in that frame. A lost link stays lost.
  void step(double now, Arrival arrival);
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] double gain() const { return gain_; }

 private:
  StaleRule rule_;
  State state_ = State::fresh;
  double gain_ = 1.0;
  double last_new_ = 0.0;
  double last_step_ = 0.0;
  bool begun_ = false;
};

// The box in which forces are rendered.
struct Workspace {
  Vec3 low = Vec3::Constant(-Limits::none);  // m
  Vec3 high = Vec3::Constant(Limits::none);  // m
  [[nodiscard]] bool holds(const Vec3& position) const {
    return (position.array() >= low.array()).all() && (position.array() <= high.array()).all();
  }
};

// Accepts a position only if the device can have reached it since the last accepted position.
class JumpCheck {
 public:
  // `fastest` in m/s; `slack` in m, the error of a reading.
  JumpCheck(double fastest, double slack) : fastest_(fastest), slack_(slack) {}
  [[nodiscard]] bool takes(double now, const Vec3& position);

 private:
  double fastest_;
  double slack_;
  Vec3 last_ = Vec3::Zero();
  double time_ = 0.0;
  bool any_ = false;
};

}  // namespace palpate::device
