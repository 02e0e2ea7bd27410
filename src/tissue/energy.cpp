// Sums over springs in index order.
#include "tissue/energy.h"

namespace palpate::tissue {

double stored_energy(const Network& network, const ViscousLaw& law,
                     std::span<const Memory> memory) {
  const bool branch = law.kind == Viscosity::standard_linear_solid;
  double sum = 0.0;
  for (std::size_t s = 0; s < memory.size(); ++s) {
    const double e = memory[s].elongation;
    const double stretched = branch ? e - memory[s].internal : 0.0;
    sum += 0.5 * network.stiffness[s] * (e * e + law.branch * stretched * stretched);
  }
  return sum;
}

double dissipated_energy(const Network& network, const ViscousLaw& law,
                         std::span<const Memory> before, std::span<const Memory> after,
                         const Vector& moved, double time_step) {
  double sum = 0.0;
  if (law.kind == Viscosity::kelvin_voigt) {
    for (std::size_t s = 0; s < after.size(); ++s) {
      const double change = after[s].elongation - before[s].elongation;
      sum += network.stiffness[s] * law.time * change * change / time_step;
    }
  } else if (law.kind == Viscosity::standard_linear_solid) {
    for (std::size_t s = 0; s < after.size(); ++s) {
      const double stretched = 0.5 * (before[s].elongation - before[s].internal +
                                      after[s].elongation - after[s].internal);
      sum +=
          network.stiffness[s] * law.branch * stretched * (after[s].internal - before[s].internal);
    }
  } else if (law.kind == Viscosity::nodal_drag) {
    for (Eigen::Index d = 0; d < moved.size(); ++d)
      sum += network.node_mass[static_cast<std::size_t>(d / 3)] * law.drag * moved[d] * moved[d] /
             time_step;
  }
  return sum;
}

}  // namespace palpate::tissue
