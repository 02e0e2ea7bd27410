// The viscous law of springs, and the memory that steps it through time.
#pragma once

#include <span>
#include <vector>

namespace palpate::tissue {

// none: k e. nodal_drag: k e, and d v on each node against the ground (eq. 10).
// kelvin_voigt: k (e + tau e'), the damper of Fig. 4 along each edge.
// standard_linear_solid: k e + k_1 (e - q), q' = (e - q) / tau.  prony: several such branches.
enum class Viscosity { none, nodal_drag, kelvin_voigt, standard_linear_solid, prony };

struct Branch {
  double time = 0.0;   // s, tau of its relaxation
  double ratio = 0.0;  // k_1 / k
};

struct ViscousLaw {
  Viscosity kind = Viscosity::none;
  double time = 0.0;                  // s, the retardation time of Kelvin-Voigt
  std::vector<Branch> branches = {};  // of the standard linear solid (one) and of prony
  double drag = 0.0;                  // 1/s: d_i / m_i of nodal drag

  [[nodiscard]] double instantaneous_ratio() const;  // E_0 / E_inf = 1 + sum of ratios
  [[nodiscard]] double shortest_time() const;        // s, 0 without any
  [[nodiscard]] double longest_time() const;         // s, 0 without any
};

// One step of  tau q' = e - q  or, read backwards, of  tau e' = s/k - e:
//   q_1 = keep q_0 + begin e_0 + end e_1.
// Exact for e that changes linearly in the step (`exact`), for e that has its end value all along
// (`held`), implicit Euler (`first_order`), or explicit Euler of q (`forward`, from an elongation
// that stays: e_0 = e_1). `at_once` is no time at all: q stays,
// and a Kelvin-Voigt spring is elastic.
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

// What springs remember lies in one array, memory_size() numbers a spring: the elongation at the
// last step (m), and the internal elongation q of every branch, or of Kelvin-Voigt the effective
// elongation (m). `steps` has one entry a branch; of Kelvin-Voigt one.
[[nodiscard]] std::size_t memory_size(const ViscousLaw& law);

// Springs pull as elastic ones of the effective elongation would: tensions() of it, whether they
// are coupled or not, because all have the same times.                docs/theory.md (36), (37)
// At the end of a step to `elongation`:
void effective_elongations(const ViscousLaw& law, std::span<const MemoryStep> steps,
                           std::span<const double> memory, std::span<const double> elongation,
                           std::span<double> effective);

// d(effective) / d(elongation) of that.
[[nodiscard]] double effective_slope(const ViscousLaw& law, std::span<const MemoryStep> steps);

// At this very moment, without dashpots: e + sum of ratio (e - q).
void elastic_elongations(const ViscousLaw& law, std::span<const double> memory,
                         std::span<const double> elongation, std::span<double> effective);

// The memory after the step.
void remember(const ViscousLaw& law, std::span<const MemoryStep> steps,
              std::span<const double> elongation, std::span<double> memory);

}  // namespace palpate::tissue
