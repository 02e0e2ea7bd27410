// Limits of a stand's force and travel, and its reaction to missing samples.
#include "device/stand_safety.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {

StandSafety::Verdict StandSafety::step(double now, const Sample& sample) {
  bool good = sample.arrival == Arrival::fresh && std::isfinite(sample.force) &&
              sample.position.allFinite();
  if (good) {
    good = jump_.takes(now, sample.position);
    jumps_ = good ? 0 : jumps_ + 1;
    if (jumps_ >= 2) arming_.trip(Trip::jump);
    // The limit holds for either sign, because the gauge's sign may be inverted.
    if (std::abs(sample.force) > rules_.force) arming_.trip(Trip::force_ceiling);
  }
  staleness_.step(now, good                              ? Arrival::fresh
                       : sample.arrival == Arrival::lost ? Arrival::lost
                                                         : Arrival::none);
  if (good) {
    last_ = sample;
    any_ = true;
    const double z = sample.position.z();
    if (z < rules_.low - rules_.slack || z > rules_.high + rules_.slack) arming_.trip(Trip::travel);
  }
  if (sample.fault == Fault::overload) arming_.trip(Trip::overload);
  if (staleness_.state() == Staleness::State::lost) arming_.trip(Trip::link_lost);
  if (arming_.tripped() != Trip::none) return Verdict::stop;
  return staleness_.state() == Staleness::State::stale ? Verdict::halt : Verdict::go_on;
}

bool StandSafety::arm(Fault limits_in_device) {
  if (limits_in_device != Fault::none || !any_) return false;
  if (staleness_.state() != Staleness::State::fresh) return false;
  const double z = last_.position.z();
  if (z < rules_.low || z > rules_.high) return false;
  return arming_.arm();
}

Motion StandSafety::allow(const Motion& wanted) const {
  const Motion none{Motion::Act::stop, 0.0};
  if (!arming_.armed() || staleness_.state() != Staleness::State::fresh) return none;
  if (wanted.act == Motion::Act::stop || !(wanted.speed > 0.0)) return none;
  const double z = last_.position.z();
  if (wanted.act == Motion::Act::down && z <= rules_.low) return none;
  if (wanted.act == Motion::Act::up && z >= rules_.high) return none;
  return {wanted.act, std::min(wanted.speed, rules_.fastest)};
}

}  // namespace palpate::device
