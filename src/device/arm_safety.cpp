// Rules of one frame. allow() applies them in the order: finite, gains, damping, norm, slew rate.
#include "device/arm_safety.h"

#include <algorithm>

namespace palpate::device {

ArmSafety::ArmSafety(const ArmRules& rules)
    : rules_(rules),
      start_(rules.start_time),
      staleness_(rules.stale),
      jump_(rules.jump_speed, rules.jump_slack),
      controller_(rules.passivity == ArmRules::Passivity::control ? rules.damping : 0.0) {}

bool ArmSafety::take(double now, const Sample& sample) {
  bool good = sample.arrival == Arrival::fresh && sample.position.allFinite() &&
              sample.velocity.allFinite();
  if (good && !jump_.takes(now, sample.position)) {
    ++counts_.jumps;
    good = false;
  }
  if (sample.fault == Fault::brake || sample.fault == Fault::stalled ||
      sample.fault == Fault::unstable)
    arming_.trip(Trip::brake);
  const Arrival arrival = good                              ? Arrival::fresh
                          : sample.arrival == Arrival::lost ? Arrival::lost
                                                            : Arrival::none;
  staleness_.step(now, arrival);
  if (staleness_.state() == Staleness::State::stale) ++counts_.stale;
  if (staleness_.state() == Staleness::State::lost) arming_.trip(Trip::link_lost);
  if (!good) return false;
  observer_.step(sample.position, slew_.last());
  position_ = sample.position;
  velocity_ = sample.velocity;
  any_ = true;
  return true;
}

bool ArmSafety::arm(double now, double depth) {
  if (!any_ || staleness_.state() != Staleness::State::fresh) return false;
  if (arming_.tripped() != Trip::none || !start_.start(now, depth)) return false;
  return arming_.arm();
}

double ArmSafety::gain(double now) {
  if (!arming_.armed() || !any_) return 0.0;
  double gain = start_.gain(now) * staleness_.gain();
  if (!rules_.workspace.holds(position_)) {
    ++counts_.outside;
    gain = 0.0;
  }
  if (velocity_.norm() > rules_.fastest) {
    ++counts_.too_fast;
    gain = 0.0;
  }
  return gain;
}

Vec3 ArmSafety::allow(double now, const Vec3& wanted) {
  const double dt = began_ ? std::clamp(now - last_allow_, 0.0, rules_.stale.fall) : 0.0;
  last_allow_ = now;
  began_ = true;
  if (staleness_.state() == Staleness::State::lost) {
    slew_.drop();
    return slew_.last();
  }
  if (!wanted.allFinite()) ++counts_.not_finite;
  const double share = gain(now);
  Vec3 force = share * clamped_norm(finite_or_zero(wanted), rules_.force);
  if (share > 0.0) {
    if (wanted.allFinite() && wanted.norm() > rules_.force) ++counts_.clamped;
    if (rules_.passivity == ArmRules::Passivity::control) {
      force += share * controller_.step(observer_, velocity_, rules_.frame);
      if (controller_.damping() > 0.0) ++counts_.damped;
    }
  }
  force = clamped_norm(finite_or_zero(force), rules_.force);
  // The slew limit must not delay a fall of the force that another rule requires.
  const bool falls = staleness_.state() == Staleness::State::stale || !arming_.armed();
  const double rate = falls ? std::max(rules_.slew, rules_.force / rules_.stale.fall) : rules_.slew;
  Vec3 sent = slew_.step(force, dt, rate);
  if (sent != force) ++counts_.slewed;
  return sent;
}

}  // namespace palpate::device
