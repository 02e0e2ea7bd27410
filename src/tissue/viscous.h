// The viscous law of springs, and the memory with which it is integrated over time.
#pragma once

#include <span>
#include <vector>

namespace palpate::tissue {

// none: k e. nodal_drag: k e, and a drag d v of each node against the ground (Chen 2007 eq. 10).
// kelvin_voigt: k (e + tau e'), a damper along each edge (Chen 2007 Fig. 4).
// standard_linear_solid: k e + k_1 (e - q), q' = (e - q) / tau.  prony: several such branches.
enum class Viscosity { none, nodal_drag, kelvin_voigt, standard_linear_solid, prony };

struct Branch {
  double time = 0.0;   // s, relaxation time tau
  double ratio = 0.0;  // k_1 / k
};

struct ViscousLaw {
  Viscosity kind = Viscosity::none;
  double time = 0.0;                  // s, the retardation time of Kelvin-Voigt
  std::vector<Branch> branches = {};  // of the standard linear solid (one) and of prony
  double drag = 0.0;                  // 1/s: d_i / m_i of nodal drag

  [[nodiscard]] double instantaneous_ratio() const;  // E_0 / E_inf = 1 + sum of ratios
  [[nodiscard]] double shortest_time() const;        // s, 0 if there is none
  [[nodiscard]] double longest_time() const;         // s, 0 if there is none
};

// Coefficients of one step of  tau q' = e - q  or, solved for its input, of  tau e' = s/k - e:
//   q_1 = keep q_0 + begin e_0 + end e_1.                              docs/theory.md [memory]
// exact: exact if e is linear in the step. held: exact if e has its final value during the whole
// step. first_order: implicit Euler. forward: explicit Euler of q at a constant e. at_once: a step
// that takes no time, in which q stays and a Kelvin-Voigt spring is elastic.
struct MemoryStep {
  double keep = 1.0;
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] static MemoryStep exact(double time_step, double time);
  [[nodiscard]] static MemoryStep held(double time_step, double time);
  [[nodiscard]] static MemoryStep first_order(double time_step, double time);
  [[nodiscard]] static MemoryStep forward(double time_step, double time);
  [[nodiscard]] static MemoryStep at_once() { return {}; }
};

// What a law remembers of elongations e (m) or, because all springs have the same times, of the
// displacements of a body whose springs do not turn: memory_size() arrays as long as e, one after
// the other. They are e at the last step, then the internal elongation q of every branch or, for
// Kelvin-Voigt, the effective elongation s/k. Other laws have no memory. `steps` has one entry per
// branch, and one for Kelvin-Voigt.
[[nodiscard]] std::size_t memory_size(const ViscousLaw& law);

// The effective elongations (m) at the end of a step to `elongation`. A spring has the tension that
// an elastic spring with its effective elongation would have. This holds for coupled springs too,
// because all springs have the same times.            docs/theory.md [kelvin_voigt], [branches]
void effective_elongations(const ViscousLaw& law, std::span<const MemoryStep> steps,
                           std::span<const double> memory, std::span<const double> elongation,
                           std::span<double> effective);

// The derivative d(effective) / d(elongation) of effective_elongations().
[[nodiscard]] double effective_slope(const ViscousLaw& law, std::span<const MemoryStep> steps);

// Advances the memory by a step to `elongation`.
void remember(const ViscousLaw& law, std::span<const MemoryStep> steps,
              std::span<const double> elongation, std::span<double> memory);

}  // namespace palpate::tissue
