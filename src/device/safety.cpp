// The safety rules that stand and arm share, and the rules of each.
#include "device/safety.h"

#include <algorithm>
#include <cmath>

#include "base/words.h"

namespace palpate::device {

constexpr auto trips = words_of<Trip>({
    {"none", "nothing has tripped"},
    {"by_hand", "it was disarmed"},
    {"link_lost", "the link is lost"},
    {"inside_tissue", "the finger was inside the tissue at the start"},
    {"brake", "the device's own safety has acted"},
    {"force_ceiling", "the force went beyond its ceiling"},
    {"travel", "the travel went beyond its limits"},
    {"jump", "the position jumped, as after a reset of the stand"},
    {"overload", "the gauge is overloaded"},
    {"not_verified", "the device did not confirm a limit or a stop"},
});

const char* trip_text(Trip trip) { return trips[as_index(trip)].meaning; }

bool Arming::arm() {
  armed_ = trip_ == Trip::none;
  return armed_;
}

void Arming::trip(Trip why) {
  armed_ = false;
  if (trip_ == Trip::none) trip_ = why;
}

Vec3 finite_or_zero(const Vec3& force) { return force.allFinite() ? force : Vec3::Zero(); }

Vec3 clamped_norm(const Vec3& force, double most) {
  // Scaling by the largest component keeps squares from overflowing.
  const double largest = force.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return Vec3::Zero();
  const double norm = largest * (force / largest).norm();
  if (norm <= most) return force;
  return (force / largest) * (most / (force / largest).norm());
}

Vec3 SlewLimit::step(const Vec3& wanted, double dt, double rate) {
  const Vec3 change = clamped_norm(wanted - last_, rate * std::max(0.0, dt));
  // If `wanted` is reached, it is returned exactly, so that a force falls to exactly zero.
  last_ = (wanted - last_ - change).isZero(0.0) ? wanted : Vec3(last_ + change);
  return last_;
}

bool StartRamp::start(double now, double depth) {
  if (!(depth <= 0.0)) return false;
  begin_ = now;
  started_ = true;
  return true;
}

double StartRamp::gain(double now) const {
  if (!started_) return 0.0;
  return std::clamp((now - begin_) / time_, 0.0, 1.0);
}

void Staleness::step(double now, Arrival arrival) {
  if (!begun_) {
    begun_ = true;
    last_new_ = last_step_ = now;
  }
  const double dt = std::max(0.0, now - last_step_);
  last_step_ = now;
  if (state_ == State::lost) {
    gain_ = std::max(0.0, gain_ - dt / rule_.fall);
    return;
  }
  const double age = now - last_new_;
  if (arrival == Arrival::fresh) last_new_ = now;
  // A sample that comes after `lost_after` is too late, even if it comes within one long frame.
  if (arrival == Arrival::lost || age > rule_.lost_after) {
    state_ = State::lost;
  } else {
    state_ = arrival != Arrival::fresh && age > rule_.stale_after ? State::stale : State::fresh;
  }
  if (state_ == State::fresh) {
    gain_ = std::min(1.0, gain_ + dt / rule_.rise);
  } else {
    gain_ = std::max(0.0, gain_ - dt / rule_.fall);
  }
}

bool JumpCheck::takes(double now, const Vec3& position) {
  if (!position.allFinite()) return false;
  const double reach = fastest_ * std::max(0.0, now - time_) + slack_;
  if (any_ && (position - last_).norm() > reach) return false;
  last_ = position;
  time_ = now;
  any_ = true;
  return true;
}

// Time-domain passivity: observer and controller, docs/theory.md [arm].

void PassivityObserver::step(const Vec3& position, const Vec3& force) {
  if (any_) energy_ -= force.dot(position - last_);
  least_ = std::min(least_, energy_);
  last_ = position;
  any_ = true;
}

Vec3 PassivityController::step(const PassivityObserver& observer, const Vec3& velocity, double dt) {
  damping_ = 0.0;
  const double power = velocity.squaredNorm() * dt;  // J, dissipated by a damping of 1 N s/m
  if (observer.energy() >= 0.0 || !(power > 0.0)) return Vec3::Zero();
  // The observer receives the damped force in the next step, so nothing is added to it here.
  damping_ = std::min(most_, -observer.energy() / power);
  return -damping_ * velocity;
}

// Limits of a stand's force and travel, and its reaction to missing samples.

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

// Rules of one frame. allow() applies them in the order: finite, gains, damping, norm, slew rate.

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
