// Energy of a spring body: the energy stored, and the energy dissipated in a step.
#pragma once

#include <span>
#include <vector>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// 1/2 e.tensions(e), plus 1/2 ratio (e - q).tensions(e - q) for every branch, J. `memory` is laid
// out as in viscous.h; for a law without memory it is the elongations, m.  docs/theory.md (43)
[[nodiscard]] double stored_energy(const Network& network, const ViscousLaw& law,
                                   std::span<const double> memory);

// Buffers with one number per spring. Functions that take them allocate only in their first call.
struct EnergyScratch {
  std::vector<double> elongation, along, tension;
};
[[nodiscard]] double stored_energy(const Network& network, const ViscousLaw& law,
                                   std::span<const double> memory, EnergyScratch& scratch);

// The energy dissipated between states whose memories are `before` and `after`, and which are
// `time_step` (s) and `moved` (m) apart, J: tau (de).tensions(de) / dt of Kelvin-Voigt, ratio
// (e - q).tensions(dq) of a branch, d (du)^2 / dt of nodal drag.          docs/theory.md (43)
[[nodiscard]] double dissipated_energy(const Network& network, const ViscousLaw& law,
                                       std::span<const double> before,
                                       std::span<const double> after, const Vector& moved,
                                       double time_step);
// The same without nodal drag.
[[nodiscard]] double dissipated_energy(const Network& network, const ViscousLaw& law,
                                       std::span<const double> before,
                                       std::span<const double> after, double time_step,
                                       EnergyScratch& scratch);

}  // namespace palpate::tissue
