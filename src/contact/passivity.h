// Which contacts a haptic device with a frame rate can show without giving energy away.
#pragma once

#include "contact/balance.h"

namespace palpate::contact {

// A device that reads its place once a frame and holds a force till the next.
struct SampledDevice {
  double damping = 0.0;          // N s/m, its own: b
  double frame = 1e-3;           // s, T
  double virtual_damping = 0.0;  // N s/m, of the law that is shown: B
  double delay = 0.0;            // s, from a reading to its force: T_d
};

// The damping that a device needs to hold a wall of `stiffness` (N/m) passively, in N s/m:
//   b > K T / 2 + |B|, and about K T_d more with a delay.
// J. E. Colgate and J. M. Brown, ICRA 1994; docs/theory.md (84)
[[nodiscard]] double needed_damping(double stiffness, const SampledDevice& device);

// The stiffness that bound allows, N/m; 0 where the device's damping is not above |B|.
[[nodiscard]] double passive_stiffness(const SampledDevice& device);

// The depth (m) at which a contact law, whose stiffness grows with depth, reaches that stiffness:
// the first one that can ring in the hand. Infinite where the law ends before.
[[nodiscard]] double passive_depth(const PointLaw& law, const SampledDevice& device);

}  // namespace palpate::contact
