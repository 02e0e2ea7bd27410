// Sums over springs in index order.
#include "tissue/energy.h"

namespace palpate::tissue {
namespace {

// One number of every spring's memory.
std::vector<double> column(const ViscousLaw& law, std::span<const double> memory,
                           std::size_t which) {
  const std::size_t size = memory_size(law);
  std::vector<double> values(memory.size() / size);
  for (std::size_t s = 0; s < values.size(); ++s) values[s] = memory[size * s + which];
  return values;
}

// e - q of a branch.
std::vector<double> stretched(const ViscousLaw& law, std::span<const double> memory,
                              std::size_t branch) {
  std::vector<double> values = column(law, memory, 0);
  const std::vector<double> internal = column(law, memory, 1 + branch);
  for (std::size_t s = 0; s < values.size(); ++s) values[s] -= internal[s];
  return values;
}

std::vector<double> difference(std::vector<double> after, const std::vector<double>& before) {
  for (std::size_t s = 0; s < after.size(); ++s) after[s] -= before[s];
  return after;
}

}  // namespace

double stored_energy(const Network& network, const ViscousLaw& law,
                     std::span<const double> memory) {
  const std::vector<double> elongation = column(law, memory, 0);
  double sum = 0.5 * work(network, elongation, elongation);
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    const std::vector<double> e = stretched(law, memory, i);
    sum += 0.5 * law.branches[i].ratio * work(network, e, e);
  }
  return sum;
}

double dissipated_energy(const Network& network, const ViscousLaw& law,
                         std::span<const double> before, std::span<const double> after,
                         const Vector& moved, double time_step) {
  if (law.kind == Viscosity::kelvin_voigt) {
    const std::vector<double> change = difference(column(law, after, 0), column(law, before, 0));
    return law.time * work(network, change, change) / time_step;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    std::vector<double> mean = stretched(law, before, i);
    const std::vector<double> end = stretched(law, after, i);
    for (std::size_t s = 0; s < mean.size(); ++s) mean[s] = 0.5 * (mean[s] + end[s]);
    const std::vector<double> flow =
        difference(column(law, after, 1 + i), column(law, before, 1 + i));
    sum += law.branches[i].ratio * work(network, mean, flow);
  }
  if (law.kind == Viscosity::nodal_drag)
    for (Eigen::Index d = 0; d < moved.size(); ++d)
      sum += network.node_mass[static_cast<std::size_t>(d / 3)] * law.drag * moved[d] * moved[d] /
             time_step;
  return sum;
}

}  // namespace palpate::tissue
