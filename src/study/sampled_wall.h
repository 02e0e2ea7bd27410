// A wall that a haptic device shows once a frame, simulated; and when it alone would ring.
#pragma once

#include "contact/passivity.h"

namespace palpate::study {

// m x'' + b x' = F: the device by itself, held by no hand.
struct Device {
  double mass = 0.045;  // kg, the inertia of a desktop arm by its maker's data sheet
  contact::SampledDevice sampled;
};

// A wall of this stiffness (N/m) whose force is held through each frame: whether the energy of the
// device on it grows. The wall pulls as it pushes, so that the motion is linear. Between frames the
// motion is exact.
[[nodiscard]] bool wall_gains_energy(const Device& device, double stiffness);

// The stiffness (N/m) above which the same motion grows, without virtual damping and delay: where a
// root of (z - 1) (z - E) + K (c_1 z + c_0) leaves the unit circle, E = exp(-b T / m),
// c_1 = (T - (m/b)(1 - E)) / b, c_0 = ((m/b)(1 - E) - T E) / b. For b T << m it is
// (2 b / T) (1 + b T / (6 m)): Colgate and Brown's bound, which holds with any passive hand, and a
// little more.
[[nodiscard]] double wall_stiffness_limit(const Device& device);

// A hand pushes with a force (N) onto the wall, which only pushes. The share of frames, of the last
// half of `frames`, in which the contact is there in one and gone in the next or the other way
// round.
struct Push {
  double force = 1.0;  // N
  int frames = 20000;
};
[[nodiscard]] double chatter_share(const Device& device, double stiffness, const Push& push);

}  // namespace palpate::study
