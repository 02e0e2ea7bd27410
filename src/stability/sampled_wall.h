// Simulates a haptic device on a virtual wall whose force changes once per frame.
#pragma once

#include "contact/passivity.h"

namespace palpate::stability {

// m x'' + b x' = F: the device without a hand.
struct Device {
  double mass = 0.045;  // kg, of a desktop arm according to its data sheet
  contact::SampledDevice sampled;
};

// Whether the energy of the device on a wall of this stiffness (N/m) grows. The force is constant
// during a frame, in which the motion is exact. The wall is bilateral: the motion is linear.
[[nodiscard]] bool wall_gains_energy(const Device& device, double stiffness);

// The fraction of the last `frames` / 2 frames in which contact begins or ends while a hand presses
// with a constant `force` (N) on a wall of this stiffness (N/m) that only pushes.
struct Push {
  double force = 1.0;  // N
  int frames = 20000;
};
[[nodiscard]] double chatter_share(const Device& device, double stiffness, const Push& push);

}  // namespace palpate::stability
