// Energy of a spring body: stored, moving, and lost in a step.
#pragma once

#include <span>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// sum 1/2 k e^2, and 1/2 k_1 (e - q)^2 in the branch of a standard linear solid, J.
[[nodiscard]] double stored_energy(const Network& network, const ViscousLaw& law,
                                   std::span<const Memory> memory);

// What the dampers took between two states `time_step` seconds apart, J: k tau (de)^2 / dt of
// Kelvin-Voigt, k_1 (e - q) dq of the standard linear solid, d (du)^2 / dt of nodal drag.
[[nodiscard]] double dissipated_energy(const Network& network, const ViscousLaw& law,
                                       std::span<const Memory> before,
                                       std::span<const Memory> after, const Vector& moved,
                                       double time_step);

}  // namespace palpate::tissue
