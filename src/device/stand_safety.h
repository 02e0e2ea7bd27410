// Safety rules of a stand, which moves by itself: limits of its force, its travel and the time
// without samples. The stand stores the travel limits as well (Mark10::set_travel_limits).
#pragma once

#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

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

}  // namespace palpate::device
