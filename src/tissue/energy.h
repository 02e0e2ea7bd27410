// Energy of a spring body: stored, and lost in a step.
#pragma once

#include <span>
#include <vector>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// 1/2 e.tensions(e), and the same of e - q times its ratio in every branch, J. `memory` is laid out
// as in viscous.h.
[[nodiscard]] double stored_energy(const Network& network, const ViscousLaw& law,
                                   std::span<const double> memory);

// Room for numbers of every spring; sums with it allocate nothing after the first.
struct EnergyScratch {
  std::vector<double> elongation, along, tension;
};
[[nodiscard]] double stored_energy(const Network& network, const ViscousLaw& law,
                                   std::span<const double> memory, EnergyScratch& scratch);

// What the dampers took between two states `time_step` seconds apart, J: tau (de).tensions(de) / dt
// of Kelvin-Voigt, ratio (e - q).tensions(dq) of a branch, d (du)^2 / dt of nodal drag.
[[nodiscard]] double dissipated_energy(const Network& network, const ViscousLaw& law,
                                       std::span<const double> before,
                                       std::span<const double> after, const Vector& moved,
                                       double time_step);
// Without the nodal drag.
[[nodiscard]] double dissipated_energy(const Network& network, const ViscousLaw& law,
                                       std::span<const double> before,
                                       std::span<const double> after, double time_step,
                                       EnergyScratch& scratch);

}  // namespace palpate::tissue
