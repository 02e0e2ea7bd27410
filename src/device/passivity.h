// Energy that goes into the hand, watched and held back. The force of a frame is held until the
// next position is read, so that the energy between two readings is exact: F_k-1 . (x_k - x_k-1).
#pragma once

#include "base/vec3.h"

namespace palpate::device {

// What the hand has put in less what it got back, J:
//   E_k = E_k-1 - F_k-1 . (x_k - x_k-1)        B. Hannaford and J.-H. Ryu, IEEE TRA 18 (2002)
// A passive wall never has it below zero.
class PassivityObserver {
 public:
  // A new position (m); `force` (N) is what the hand has felt since the last one.
  void step(const Vec3& position, const Vec3& force);
  [[nodiscard]] double energy() const { return energy_; }
  [[nodiscard]] double least() const { return least_; }

  // Out of contact: what the tissue has eaten before is no credit for later.
  void forget_surplus() { energy_ = energy_ < 0.0 ? energy_ : 0.0; }

 private:
  Vec3 last_ = Vec3::Zero();
  bool any_ = false;
  double energy_ = 0.0;
  double least_ = 0.0;
};

// Takes the deficit out by a damping on the hand, in the frame after it was seen:
//   F = F - alpha v,  alpha = -E / (v . v dt) where E < 0, at most `most`
class PassivityController {
 public:
  // `most` in N s/m: what the device itself renders stably, below b of Colgate's bound.
  explicit PassivityController(double most) : most_(most) {}
  // The force to add (N), for the velocity v (m/s) of this frame and its length dt (s).
  Vec3 step(const PassivityObserver& observer, const Vec3& velocity, double dt);
  [[nodiscard]] double damping() const { return damping_; }  // N s/m, of the last frame

 private:
  double most_;
  double damping_ = 0.0;
};

}  // namespace palpate::device
