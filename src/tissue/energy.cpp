// Energies as sums over springs in index order.
#include "tissue/energy.h"

namespace palpate::tissue {
namespace {

// Gets one number of the memory of every spring.
void column(const ViscousLaw& law, std::span<const double> memory, std::size_t which,
            std::vector<double>& values) {
  const std::size_t size = memory_size(law);
  values.resize(memory.size() / size);
  for (std::size_t s = 0; s < values.size(); ++s) values[s] = memory[size * s + which];
}

// One number of every spring's memory; difference() subtracts such numbers, a - b.
struct Number {
  std::span<const double> memory;
  std::size_t which = 0;
};
void difference(const ViscousLaw& law, const Number& a, const Number& b,
                std::vector<double>& values) {
  const std::size_t size = memory_size(law);
  values.resize(a.memory.size() / size);
  for (std::size_t s = 0; s < values.size(); ++s)
    values[s] = a.memory[size * s + a.which] - b.memory[size * s + b.which];
}

}  // namespace

double stored_energy(const Network& network, const ViscousLaw& law, std::span<const double> memory,
                     EnergyScratch& scratch) {
  std::vector<double>& e = scratch.elongation;
  if (memory_size(law) == 0)
    e.assign(memory.begin(), memory.end());
  else
    column(law, memory, 0, e);
  double sum = 0.5 * work(network, e, e, scratch.tension);
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    difference(law, {memory, 0}, {memory, 1 + i}, e);
    sum += 0.5 * law.branches[i].ratio * work(network, e, e, scratch.tension);
  }
  return sum;
}

double stored_energy(const Network& network, const ViscousLaw& law,
                     std::span<const double> memory) {
  EnergyScratch scratch;
  return stored_energy(network, law, memory, scratch);
}

double dissipated_energy(const Network& network, const ViscousLaw& law,
                         std::span<const double> before, std::span<const double> after,
                         double time_step, EnergyScratch& scratch) {
  std::vector<double>& change = scratch.along;
  if (law.kind == Viscosity::kelvin_voigt) {
    difference(law, {after, 0}, {before, 0}, change);
    return law.time * work(network, change, change, scratch.tension) / time_step;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    std::vector<double>& mean = scratch.elongation;
    std::vector<double>& end = scratch.along;
    difference(law, {before, 0}, {before, 1 + i}, mean);
    difference(law, {after, 0}, {after, 1 + i}, end);
    for (std::size_t s = 0; s < mean.size(); ++s) mean[s] = 0.5 * (mean[s] + end[s]);
    difference(law, {after, 1 + i}, {before, 1 + i}, change);
    sum += law.branches[i].ratio * work(network, mean, change, scratch.tension);
  }
  return sum;
}

double dissipated_energy(const Network& network, const ViscousLaw& law,
                         std::span<const double> before, std::span<const double> after,
                         const Vector& moved, double time_step) {
  EnergyScratch scratch;
  double sum = dissipated_energy(network, law, before, after, time_step, scratch);
  if (law.kind == Viscosity::nodal_drag)
    for (Eigen::Index d = 0; d < moved.size(); ++d)
      sum += network.node_mass[as_index(d / 3)] * law.drag * moved[d] * moved[d] / time_step;
  return sum;
}

}  // namespace palpate::tissue
