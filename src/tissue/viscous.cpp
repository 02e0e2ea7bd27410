// Kelvin-Voigt, the standard linear solid and Prony series by one recurrence.
#include "tissue/viscous.h"

#include <algorithm>
#include <cmath>

namespace palpate::tissue {

double ViscousLaw::instantaneous_ratio() const {
  double sum = 1.0;
  for (const Branch& branch : branches) sum += branch.ratio;
  return sum;
}

double ViscousLaw::shortest_time() const {
  double shortest = branches.empty() ? time : branches.front().time;
  for (const Branch& branch : branches) shortest = std::min(shortest, branch.time);
  return shortest;
}

double ViscousLaw::longest_time() const {
  double longest = time;
  for (const Branch& branch : branches) longest = std::max(longest, branch.time);
  return longest;
}

// Called when the step size changes, not in every step, so exp is allowed here.
MemoryStep MemoryStep::exact(double time_step, double time) {
  const double x = time_step / time;
  const double keep = std::exp(-x);
  const double mean = -std::expm1(-x) / x;  // (1 - e^-x) / x
  return {keep, mean - keep, 1.0 - mean};
}

MemoryStep MemoryStep::held(double time_step, double time) {
  const double x = time_step / time;
  return {std::exp(-x), 0.0, -std::expm1(-x)};
}

MemoryStep MemoryStep::first_order(double time_step, double time) {
  const double x = time_step / time;
  return {1.0 / (1.0 + x), 0.0, x / (1.0 + x)};
}

MemoryStep MemoryStep::forward(double time_step, double time) {
  const double x = time_step / time;
  return {1.0 - x, 0.0, x};
}

std::size_t memory_size(const ViscousLaw& law) {
  if (law.kind == Viscosity::kelvin_voigt) return 2;
  return law.branches.empty() ? 0 : 1 + law.branches.size();
}

namespace {

// Kelvin-Voigt: e_1 = keep e_0 + begin s_0/k + end s_1/k, solved for s_1/k
//                                                                     docs/theory.md [kelvin_voigt]
double kelvin_voigt(const MemoryStep& step, double before, double effective, double elongation) {
  // A dashpot stretched in no time only transmits an impulse; afterwards it carries no force.
  if (step.end == 0.0) return elongation;
  return (elongation - (step.keep * before + step.begin * effective)) / step.end;
}

}  // namespace

void effective_elongations(const ViscousLaw& law, std::span<const MemoryStep> steps,
                           std::span<const double> memory, std::span<const double> elongation,
                           std::span<double> effective) {
  const std::size_t count = elongation.size();
  if (law.kind == Viscosity::kelvin_voigt) {
    for (std::size_t s = 0; s < count; ++s)
      effective[s] = kelvin_voigt(steps[0], memory[s], memory[count + s], elongation[s]);
    return;
  }
  std::ranges::copy(elongation, effective.begin());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    // s/k = e + sum of k_i/k (e - q_1)                               docs/theory.md [branches]
    const double* const inner = &memory[(1 + i) * count];
    const double ratio = law.branches[i].ratio;
    const auto [keep, begin, end] = steps[i];
    for (std::size_t s = 0; s < count; ++s)
      effective[s] += ratio * (elongation[s] * (1.0 - end) - (keep * inner[s] + begin * memory[s]));
  }
}

double effective_slope(const ViscousLaw& law, std::span<const MemoryStep> steps) {
  if (law.kind == Viscosity::kelvin_voigt) return steps[0].end == 0.0 ? 1.0 : 1.0 / steps[0].end;
  double slope = 1.0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    slope += law.branches[i].ratio * (1.0 - steps[i].end);
  return slope;
}

void remember(const ViscousLaw& law, std::span<const MemoryStep> steps,
              std::span<const double> elongation, std::span<double> memory) {
  if (memory.empty()) return;
  const std::size_t count = elongation.size();
  if (law.kind == Viscosity::kelvin_voigt) {
    for (std::size_t s = 0; s < count; ++s)
      memory[count + s] = kelvin_voigt(steps[0], memory[s], memory[count + s], elongation[s]);
  } else {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      double* const inner = &memory[(1 + i) * count];
      const auto [keep, begin, end] = steps[i];
      for (std::size_t s = 0; s < count; ++s)
        inner[s] = keep * inner[s] + begin * memory[s] + end * elongation[s];
    }
  }
  std::ranges::copy(elongation, memory.begin());
}

}  // namespace palpate::tissue
