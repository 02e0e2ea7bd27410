// Energies of springs as the formulas are written, for comparison.    docs/theory.md [balance]
#pragma once

#include <span>
#include <vector>

#include "plain_springs.h"
#include "tissue/network.h"
#include "tissue/viscous.h"

namespace palpate::test {

// Array `which` of a memory of `size` arrays.
inline std::vector<double> remembered(std::span<const double> memory, std::size_t size,
                                      std::size_t which) {
  const std::size_t count = memory.size() / size;
  const auto part = memory.subspan(which * count, count);
  return {part.begin(), part.end()};
}

inline std::vector<double> minus(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t s = 0; s < a.size(); ++s) a[s] -= b[s];
  return a;
}

// 1/2 e.tensions(e), plus 1/2 ratio (e - q).tensions(e - q) for every branch, J. `memory` is that
// of springs; for a law without memory it is the elongations, m.
inline double stored_energy(const tissue::Network& network, const tissue::ViscousLaw& law,
                            std::span<const double> memory) {
  const std::size_t size = std::max<std::size_t>(1, tissue::memory_size(law));
  const std::vector<double> e = remembered(memory, size, 0);
  double sum = 0.5 * test::work(network, e, e);
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    const std::vector<double> rest = minus(e, remembered(memory, size, 1 + i));
    sum += 0.5 * law.branches[i].ratio * test::work(network, rest, rest);
  }
  return sum;
}

// The energy dissipated between states whose memories are `before` and `after`, and which are
// `time_step` (s) and `moved` (m) apart, J: tau (de).tensions(de) / dt of Kelvin-Voigt, ratio
// (e - q).tensions(dq) of a branch, d (du)^2 / dt of nodal drag.
inline double dissipated_energy(const tissue::Network& network, const tissue::ViscousLaw& law,
                                std::span<const double> before, std::span<const double> after,
                                const tissue::Vector& moved, double time_step) {
  const std::size_t size = std::max<std::size_t>(1, tissue::memory_size(law));
  double sum = 0.0;
  if (law.kind == tissue::Viscosity::kelvin_voigt) {
    const std::vector<double> change =
        minus(remembered(after, size, 0), remembered(before, size, 0));
    sum = law.time * test::work(network, change, change) / time_step;
  }
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    std::vector<double> mean = minus(remembered(before, size, 0), remembered(before, size, 1 + i));
    const std::vector<double> end =
        minus(remembered(after, size, 0), remembered(after, size, 1 + i));
    for (std::size_t s = 0; s < mean.size(); ++s) mean[s] = 0.5 * (mean[s] + end[s]);
    sum += law.branches[i].ratio *
           test::work(network, mean,
                      minus(remembered(after, size, 1 + i), remembered(before, size, 1 + i)));
  }
  if (law.kind == tissue::Viscosity::nodal_drag)
    for (Eigen::Index d = 0; d < moved.size(); ++d)
      sum += network.node_mass[as_index(d / 3)] * law.drag * moved[d] * moved[d] / time_step;
  return sum;
}

}  // namespace palpate::test
