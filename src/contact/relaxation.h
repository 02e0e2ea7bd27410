// Relaxation functions of tissue: the corresponding creep, and the effect of an elastic finger.
#pragma once

#include <vector>

namespace palpate::contact {

// One exponential term of a spectrum.
struct Branch {
  double time = 0.0;   // s, above 0
  double ratio = 0.0;  // relative to the relaxed modulus or compliance
};

// E(t) / E_inf of a tissue with constant Poisson's ratio: elastic (no branches, no retardation
// time), with Maxwell branches (one makes a standard linear solid),
//   E(t) = E_inf (1 + sum_k b_k exp(-t / tau_k)),                   docs/theory.md [relaxation]
// or Kelvin-Voigt, E(t) = E_inf (1 + tau delta(t)). Not both; times above 0, ratios at least 0.
struct Relaxation {
  std::vector<Branch> branches;   // tau_k and b_k, in any order
  double retardation_time = 0.0;  // s: tau = eta / E_inf of Kelvin-Voigt, otherwise 0

  [[nodiscard]] bool elastic() const { return branches.empty() && retardation_time == 0.0; }
  // E(t) / E_inf for t >= 0 (s); 1 for Kelvin-Voigt, without the impulse at t = 0.
  [[nodiscard]] double modulus_ratio(double time) const;
  // Stress over E_inf at `time` (s) after the start of a strain that grows at `rate` (1/s) for
  // `ramp_time` (s) and then stays.                                 docs/theory.md [compression]
  [[nodiscard]] double ramp_response(double rate, double ramp_time, double time) const;
};

// J(t) E_inf = 1 - sum_m j_m exp(-t / T_m): strain under constant stress over its final value.
struct Creep {
  std::vector<Branch> modes;  // T_m and j_m, times ascending
  // T_m - tau_k at [m n + k], computed without cancellation, for n branches with ascending tau_k;
  // empty for Kelvin-Voigt, which has no branch.
  std::vector<double> gaps;  // s

  // J(t) E_inf for t >= 0, s.
  [[nodiscard]] double compliance_ratio(double time) const;
  // The same at `time` (s) after the end of a stress that lasted for `load_time` (s).
  [[nodiscard]] double recovery_ratio(double load_time, double time) const;
};

// The creep function of a relaxation function: as many modes as branches, T_m between tau_m and
// tau_(m+1). For one branch T = tau E_0 / E_inf. For set-up only.         Park and Schapery 1999
[[nodiscard]] Creep creep(const Relaxation& relaxation);

// Sorts the branches by time, merges those of equal time and removes those with ratio 0.
[[nodiscard]] Relaxation sorted(const Relaxation& relaxation);

// The relaxation of the effective modulus E*(t) of an elastic finger in series with a relaxing
// tissue, divided by the relaxed value 1 / (lambda_1 + lambda_2). `finger_share` in [0, 1] is
// lambda_1 / (lambda_1 + lambda_2), the finger's fraction of the relaxed compliance: 0 gives
// `sorted(tissue)`, 1 an elastic contact. Kelvin-Voigt tissue becomes a standard linear solid.
// Valid if a pressure deforms both bodies alike: for two half-spaces, not for a layer.
[[nodiscard]] Relaxation behind_finger(const Relaxation& tissue, double finger_share);

}  // namespace palpate::contact
