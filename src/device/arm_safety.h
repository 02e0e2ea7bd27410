// All rules of an arm in their order: what of a sample is believed, what force may be sent.
#pragma once

#include <cstdint>

#include "device/passivity.h"
#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

struct ArmRules {
  double force = 2.0;        // N, norm of the vector; as published clients of such arms clamp
  double slew = 50.0;        // N/s, of the vector
  double start_time = 0.5;   // s
  double fastest = 1.0;      // m/s, of the hand; beyond it nothing is rendered
  double jump_speed = 5.0;   // m/s, no hand moves a position faster
  double jump_slack = 1e-3;  // m
  double frame = 1e-3;       // s, as planned
  double damping = 1.0;      // N s/m, the most that the passivity controller adds; assumed
  enum class Passivity { observe, control };
  Passivity passivity = Passivity::control;
  Workspace workspace;
  StaleRule stale;
};

// How often each rule has acted.
struct RuleCounts {
  std::uint64_t not_finite = 0;  // forces that were no numbers
  std::uint64_t clamped = 0;     // frames in which the norm was cut
  std::uint64_t slewed = 0;      // frames in which the change was cut
  std::uint64_t stale = 0;       // frames without a new sample for too long
  std::uint64_t jumps = 0;       // samples that were dropped as jumps
  std::uint64_t too_fast = 0;    // frames without a force, for the hand's speed
  std::uint64_t outside = 0;     // frames without a force, out of the workspace
  std::uint64_t damped = 0;      // frames in which the passivity controller acted
};

class ArmSafety {
 public:
  explicit ArmSafety(const ArmRules& rules);

  // Once a frame, first: what the link gave at `now` (s). True where its position and velocity
  // are to be used; the last good ones hold otherwise. Trips on a brake and on a lost link.
  bool take(double now, const Sample& sample);

  // Starts the ramp. `depth` in m, above 0 inside the tissue. False without a good sample, when it
  // is stale, inside the tissue (which trips nothing: move out and ask again), or after a trip.
  bool arm(double now, double depth);
  void disarm(Trip why = Trip::by_hand) { arming_.trip(why); }

  // Once a frame, last: the force (N) that may be sent for the one that is wanted. Always finite,
  // never above the ceiling; zero unless armed. Call it once a frame, with take()'s `now`.
  Vec3 allow(double now, const Vec3& wanted);

  // Out of contact in this frame: see PassivityObserver.
  void out_of_contact() { observer_.forget_surplus(); }

  [[nodiscard]] bool armed() const { return arming_.armed(); }
  [[nodiscard]] Trip tripped() const { return arming_.tripped(); }
  [[nodiscard]] Staleness::State freshness() const { return staleness_.state(); }
  [[nodiscard]] const PassivityObserver& observer() const { return observer_; }
  [[nodiscard]] const RuleCounts& counts() const { return counts_; }
  [[nodiscard]] const Vec3& sent() const { return slew_.last(); }  // N, by the last allow()

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
  double last_take_ = 0.0;
  bool any_ = false;    // a good sample has come
  bool began_ = false;  // allow() was called
};

}  // namespace palpate::device
