// The safety rules that stand and arm share.
#include "device/safety.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {

std::string_view trip_text(Trip trip) {
  switch (trip) {
    case Trip::none: return "nothing has tripped";
    case Trip::by_hand: return "it was disarmed";
    case Trip::link_lost: return "the link is lost";
    case Trip::inside_tissue: return "the finger was inside the tissue at the start";
    case Trip::brake: return "the device's own safety has acted";
    case Trip::force_ceiling: return "the force went beyond its ceiling";
    case Trip::travel: return "the travel went beyond its limits";
    case Trip::jump: return "the position jumped, as after a reset of the stand";
    case Trip::overload: return "the gauge is overloaded";
    case Trip::not_verified: return "the device did not confirm a limit or a stop";
  }
  return "unknown";
}

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

}  // namespace palpate::device
