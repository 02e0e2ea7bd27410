// Passivity of the arm: observes the energy given to the hand and removes an excess by damping. The
// force is constant between two readings x, so that its work is exactly F_k-1 . (x_k - x_k-1).
#pragma once

#include "base/vec3.h"

namespace palpate::device {

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

}  // namespace palpate::device
