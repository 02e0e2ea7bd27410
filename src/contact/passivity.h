// Which contact stiffness a haptic device with a given frame time can render passively.
#pragma once

#include "contact/balance.h"

namespace palpate::contact {

// A device that reads its position once per frame and holds a force until the next frame.
struct SampledDevice {
  double damping = 0.0;          // N s/m, of the device's mechanics: b
  double frame = 1e-3;           // s, T
  double virtual_damping = 0.0;  // N s/m, of the rendered law: B
  double delay = 0.0;            // s, from a position to its force: T_d
};

// The damping that a device needs to render a wall of `stiffness` (N/m) passively, N s/m:
//   b > K (T/2 + T_d) + |B|     J. E. Colgate and J. M. Brown, ICRA 1994; docs/theory.md [passive]
[[nodiscard]] double needed_damping(double stiffness, const SampledDevice& device);

// The largest stiffness that this bound allows, N/m; 0 if the device's damping is not above |B|.
[[nodiscard]] double passive_stiffness(const SampledDevice& device);

// The depth (m) at which the stiffness of a contact law, which grows with depth, reaches the
// passive stiffness and oscillations become possible. Infinite if the law ends before that depth.
[[nodiscard]] double passive_depth(const PointLaw& law, const SampledDevice& device);

}  // namespace palpate::contact
