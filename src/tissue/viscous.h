// The viscous law of a spring, and the memory that steps it through time.
#pragma once

#include <span>

namespace palpate::tissue {

// none: k e. nodal_drag: k e, and d v on each node against the ground (eq. 10).
// kelvin_voigt: k (e + tau e'), the damper of Fig. 4 along each edge.
// standard_linear_solid: k e + k_1 (e - q), q' = (e - q) / tau.
enum class Viscosity { none, nodal_drag, kelvin_voigt, standard_linear_solid };

struct ViscousLaw {
  Viscosity kind = Viscosity::none;
  double time = 0.0;    // s: retardation time of Kelvin-Voigt, relaxation time of the solid
  double branch = 0.0;  // k_1 / k of the standard linear solid: E_0 / E_inf - 1
  double drag = 0.0;    // 1/s: d_i / m_i of nodal drag
};

// One step of  tau q' = e - q  or, read backwards, of  tau e' = s/k - e:
//   q_1 = keep q_0 + begin e_0 + end e_1.
// Exact for e that changes linearly in the step (`exact`), for e that has its end value all along
// (`held`), or implicit Euler (`first_order`). `at_once` is no time at all: q stays,
// and a Kelvin-Voigt spring is elastic.
struct MemoryStep {
  double keep = 1.0;
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] static MemoryStep exact(double time_step, double time);
  [[nodiscard]] static MemoryStep held(double time_step, double time);
  [[nodiscard]] static MemoryStep first_order(double time_step, double time);
  [[nodiscard]] static MemoryStep at_once() { return {}; }
};

// What a spring remembers: its elongation at the last step, and the internal elongation q of the
// standard linear solid or the tension s of Kelvin-Voigt over k.
struct Memory {
  double elongation = 0.0;  // m
  double internal = 0.0;    // m
};

// Tension over stiffness, in m, at the end of a step that stretches the spring to `elongation`;
// `slope` is its derivative by the elongation.
struct StepTension {
  double value = 0.0;
  double slope = 1.0;
};
[[nodiscard]] StepTension step_tension(const ViscousLaw& law, const Memory& memory,
                                       const MemoryStep& step, double elongation);

// The memory after the step.
[[nodiscard]] Memory remembered(const ViscousLaw& law, const Memory& memory, const MemoryStep& step,
                                double elongation);

}  // namespace palpate::tissue
