// Safety rules between a link and its commands: those that devices share, those of a stand and
// those of an arm. Each rule is a small state machine that receives the time as an argument. The
// rules use forces, positions and times only, and no tissue model.
#pragma once

#include <cstdint>

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
[[nodiscard]] const char* trip_text(Trip trip);  // a clause

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

// Passivity of the arm: observes the energy given to the hand and removes an excess by damping. The
// force is constant between two readings x, so that its work is exactly F_k-1 . (x_k - x_k-1).

// Energy from the hand minus energy returned to the hand, J; for a passive wall never below zero:
//   E_k = E_k-1 - F_k-1 . (x_k - x_k-1)
// B. Hannaford and J.-H. Ryu, IEEE TRA 18 (2002); docs/theory.md [arm]
class PassivityObserver {
 public:
  // Adds the work of `force` (N), which has acted from the last position to this one (m).
  void step(const Vec3& position, const Vec3& force);
  [[nodiscard]] double energy() const { return energy_; }  // J
  [[nodiscard]] double least() const { return least_; }    // J, smallest energy() so far

  // Call out of contact: energy dissipated in one contact must not pay for activity in the next.
  void forget_surplus() { energy_ = energy_ < 0.0 ? energy_ : 0.0; }

 private:
  Vec3 last_ = Vec3::Zero();
  bool any_ = false;
  double energy_ = 0.0;
  double least_ = 0.0;
};

// Dissipates a deficit (E < 0) by a damping on the hand, in the frame after it was observed:
//   F = F - alpha v,  alpha = min(most, -E / (v . v dt))           docs/theory.md [arm]
class PassivityController {
 public:
  // `most` (N s/m): a damping that the device renders stably, below b of Colgate's bound [passive].
  explicit PassivityController(double most) : most_(most) {}
  // Returns the force to add (N), for the velocity v (m/s) of this frame and its length dt (s).
  Vec3 step(const PassivityObserver& observer, const Vec3& velocity, double dt);
  [[nodiscard]] double damping() const { return damping_; }  // N s/m, of the last frame

 private:
  double most_;
  double damping_ = 0.0;
};

// Safety rules of a stand, which moves by itself: limits of its force, its travel and the time
// without samples. The stand stores the travel limits as well (Mark10::set_travel_limits).

struct StandRules {
  double force = 5.0;          // N, of either sign; beyond it the stand is stopped
  double low = -Limits::none;  // m, of travel
  double high = Limits::none;  // m, of travel
  double slack = 1e-4;         // m, beyond the limits: the braking distance of the stand
  double fastest = 18.4e-3;    // m/s, the highest speed that may be commanded: 1100 mm/min
  StaleRule stale{.stale_after = 0.06, .lost_after = 0.25};
};

class StandSafety {
 public:
  explicit StandSafety(const StandRules& rules)
      : rules_(rules), staleness_(rules.stale), jump_(2.0 * rules.fastest, rules.slack) {}

  // What must be done with the stand after the sample at `now` (s). A position that the stand
  // cannot have reached is ignored; two in a row mean that its zero has changed, and trip.
  enum class Verdict {
    go_on,
    halt,  // stop the stand; it may be started again when samples come
    stop,  // stop the stand for good; tripped() returns the reason
  };
  Verdict step(double now, const Sample& sample);

  // Allows motion if the device has confirmed its limits (`limits_in_device` is none) and the last
  // sample is fresh and lies within the limits. False otherwise, and after a trip.
  bool arm(Fault limits_in_device);
  void disarm() { arming_.trip(Trip::by_hand); }

  // Returns the motion that may be commanded instead of `wanted`: the speed is limited to
  // `fastest`; it is a stop if the stand is not armed, the samples are not fresh, or the stand has
  // already reached the limit towards which it would move.
  [[nodiscard]] Motion allow(const Motion& wanted) const;

  [[nodiscard]] bool armed() const { return arming_.armed(); }
  [[nodiscard]] Trip tripped() const { return arming_.tripped(); }
  [[nodiscard]] Staleness::State freshness() const { return staleness_.state(); }

 private:
  StandRules rules_;
  Arming arming_;
  Staleness staleness_;
  JumpCheck jump_;
  int jumps_ = 0;  // in a row
  Sample last_;
  bool any_ = false;
};

// The safety rules of an arm in their order: which samples are used, and which force may be sent.

struct ArmRules {
  double force = 2.0;        // N, limit of the vector's norm, as in published clients of such arms
  double slew = 50.0;        // N/s, limit of the vector's rate of change
  double start_time = 0.5;   // s, of the ramp after arming
  double fastest = 1.0;      // m/s; no force is rendered if the hand moves faster
  double jump_speed = 5.0;   // m/s, faster than any hand
  double jump_slack = 1e-3;  // m
  double frame = 1e-3;       // s, planned
  double damping = 1.0;      // N s/m, the largest that the passivity controller adds; assumed
  enum class Passivity { observe, control };
  Passivity passivity = Passivity::control;
  Workspace workspace;
  StaleRule stale;
};

// How often each rule has acted.
struct RuleCounts {
  std::uint64_t not_finite = 0;  // requested forces that were not finite
  std::uint64_t clamped = 0;     // frames in which the norm was limited
  std::uint64_t slewed = 0;      // frames in which the rate of change was limited
  std::uint64_t stale = 0;       // frames in which the last sample was too old
  std::uint64_t jumps = 0;       // samples that were dropped as jumps
  std::uint64_t too_fast = 0;    // frames without force because of the hand's speed
  std::uint64_t outside = 0;     // frames without force because the hand left the workspace
  std::uint64_t damped = 0;      // frames in which the passivity controller acted
};

class ArmSafety {
 public:
  explicit ArmSafety(const ArmRules& rules);

  // First call of a frame, with the link's sample at `now` (s). True if its position and velocity
  // may be used; if not, continue with the last good ones. Trips if the sample reports a brake, a
  // stalled motor or the stability ceiling, and if the link is lost.
  bool take(double now, const Sample& sample);

  // Starts the ramp. `depth` (m) is above 0 inside the tissue. False without a good sample, if it
  // is stale, inside the tissue (without a trip: move out and try again), and after a trip.
  bool arm(double now, double depth);
  void disarm(Trip why = Trip::by_hand) { arming_.trip(why); }

  // Last call of a frame, with the `now` of take(): returns the force (N) that may be sent instead
  // of `wanted`. It is always finite and never above `force` of the rules. Unless armed, it falls
  // to zero within `stale.fall`; if the link is lost, it is zero at once.
  Vec3 allow(double now, const Vec3& wanted);

  // Call in frames without contact: see PassivityObserver::forget_surplus.
  void out_of_contact() { observer_.forget_surplus(); }

  [[nodiscard]] bool armed() const { return arming_.armed(); }
  [[nodiscard]] Trip tripped() const { return arming_.tripped(); }
  [[nodiscard]] Staleness::State freshness() const { return staleness_.state(); }
  [[nodiscard]] const PassivityObserver& observer() const { return observer_; }
  [[nodiscard]] const RuleCounts& counts() const { return counts_; }
  [[nodiscard]] const Vec3& sent() const { return slew_.last(); }  // N, the last result of allow()

 private:
  [[nodiscard]] double gain(double now);

  ArmRules rules_;
  Arming arming_;
  StartRamp start_;
  Staleness staleness_;
  JumpCheck jump_;
  SlewLimit slew_;
  PassivityObserver observer_;
  PassivityController controller_;
  RuleCounts counts_;
  Vec3 position_ = Vec3::Zero();
  Vec3 velocity_ = Vec3::Zero();
  double last_allow_ = 0.0;
  bool any_ = false;    // a good sample has come
  bool began_ = false;  // allow() was called
};

}  // namespace palpate::device
