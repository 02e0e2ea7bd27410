// The rules of a stand: it moves us, so that what is limited is its force, its travel and its
// silence. The travel limits are in the stand itself, too (Mark10::set_travel_limits).
#pragma once

#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

struct StandRules {
  double force = 5.0;          // N, either sign; beyond it the stand is stopped
  double low = -Limits::none;  // m, of travel
  double high = Limits::none;  // m
  double slack = 1e-4;         // m, beyond the limits: the stand's way to a stand-still
  double fastest = 18.4e-3;    // m/s, that may be commanded: 1100 mm/min
  StaleRule stale{.stale_after = 0.06, .lost_after = 0.25};
};

class StandSafety {
 public:
  explicit StandSafety(const StandRules& rules)
      : rules_(rules), staleness_(rules.stale), jump_(2.0 * rules.fastest, rules.slack) {}

  // What is to be done with the stand now. A position that no stand can have reached is dropped;
  // two in a row mean that its zero is another one, and stop it.
  enum class Verdict {
    go_on,
    halt,  // stop it; it may be started again when samples come
    stop,  // stop it for good: tripped() says why
  };
  Verdict step(double now, const Sample& sample);

  // Motion is allowed only once armed, which wants verified limits and a fresh sample within them.
  bool arm(Fault limits_in_device);
  void disarm() { arming_.trip(Trip::by_hand); }

  // The motion that may be commanded for the one that is wanted: a stop unless armed and fresh; its
  // speed cut; away from a limit that was reached only.
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
