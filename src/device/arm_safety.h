// The safety rules of an arm in their order: which samples are used, and which force may be sent.
#pragma once

#include <cstdint>

#include "device/passivity.h"
#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

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
