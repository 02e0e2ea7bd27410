// Rules between a link and what may be commanded: each a small state machine stepped with explicit
// time, none with a clock inside. They know forces, places and times, and no tissue.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/vec3.h"
#include "device/sample.h"

namespace palpate::device {

// Why nothing may be commanded any more. The first one stays: nothing re-arms by itself.
enum class Trip : std::uint8_t {
  none,
  by_hand,        // disarmed by the program or the person
  link_lost,      // hung up, or silent for longer than the link may be
  inside_tissue,  // a start was asked for while the finger was in the tissue
  brake,          // the device's own safety has acted
  force_ceiling,  // a stand's force is beyond what was allowed
  travel,         // a stand is beyond its travel limits
  jump,           // a stand's position changed as no stand can move
  overload,       // a gauge cannot measure any more
  not_verified,   // a limit or a stop was not confirmed
};
[[nodiscard]] std::string_view trip_text(Trip trip);  // a clause

// Armed only when asked to; once tripped it stays tripped.
class Arming {
 public:
  // False where it has tripped before.
  bool arm();
  void trip(Trip why);
  [[nodiscard]] bool armed() const { return armed_; }
  [[nodiscard]] Trip tripped() const { return trip_; }

 private:
  bool armed_ = false;
  Trip trip_ = Trip::none;
};

// Zero where any component is not finite.
[[nodiscard]] Vec3 finite_or_zero(const Vec3& force);

// The vector shortened to `most` (N), its direction kept.
[[nodiscard]] Vec3 clamped_norm(const Vec3& force, double most);

// A force that changes no faster than `rate`, as a vector.
class SlewLimit {
 public:
  // Goes towards `wanted` for `dt` (s) at `rate` (N/s) at most.
  Vec3 step(const Vec3& wanted, double dt, double rate);
  void drop() { last_ = Vec3::Zero(); }  // at once
  [[nodiscard]] const Vec3& last() const { return last_; }

 private:
  Vec3 last_ = Vec3::Zero();
};

// A gain from 0 to 1 over `time` from the start, which is refused inside tissue.
class StartRamp {
 public:
  explicit StartRamp(double time) : time_(time) {}  // s
  // `depth` in m, above 0 inside the tissue; false, and no start, there or where it is no number.
  bool start(double now, double depth);
  [[nodiscard]] double gain(double now) const;
  [[nodiscard]] bool started() const { return started_; }

 private:
  double time_;
  double begin_ = 0.0;
  bool started_ = false;
};

// How old the last new sample is, and what follows from it.
struct StaleRule {
  double stale_after = 3e-3;  // s
  double lost_after = 0.1;    // s
  double fall = 0.05;         // s, in which the gain goes from 1 to 0
  double rise = 0.5;          // s, back from 0 to 1 when samples come again
};
class Staleness {
 public:
  enum class State { fresh, stale, lost };
  explicit Staleness(const StaleRule& rule) : rule_(rule) {}
  // Called every frame, with whether a new sample has come in it. Lost stays lost.
  void step(double now, Arrival arrival);
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] double gain() const { return gain_; }
  [[nodiscard]] double age(double now) const { return begun_ ? now - last_new_ : 0.0; }

 private:
  StaleRule rule_;
  State state_ = State::fresh;
  double gain_ = 1.0;
  double last_new_ = 0.0;
  double last_step_ = 0.0;
  bool begun_ = false;
};

// Where the device may be; outside of it nothing is rendered.
struct Workspace {
  Vec3 low = Vec3::Constant(-Limits::none);  // m
  Vec3 high = Vec3::Constant(Limits::none);  // m
  [[nodiscard]] bool holds(const Vec3& position) const {
    return (position.array() >= low.array()).all() && (position.array() <= high.array()).all();
  }
};

// A position is taken only where the device can have got there since the last one taken.
class JumpCheck {
 public:
  // `fastest` in m/s; `slack` in m, what a reading may be off by.
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
