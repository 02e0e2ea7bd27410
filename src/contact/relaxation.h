// How a tissue's stiffness fades with time: its relaxation function, its creep, a finger before it.
#pragma once

#include <vector>

namespace palpate::contact {

// One exponential of a spectrum.
struct Branch {
  double time = 0.0;   // s, above 0
  double ratio = 0.0;  // of the relaxed modulus or compliance, 1
};

// E(t) / E_inf of a tissue whose Poisson's ratio does not change: elastic (both empty), with
// relaxing branches, one of which makes a standard linear solid,
//   E(t) = E_inf (1 + sum_k b_k exp(-t / tau_k)),
// or Kelvin-Voigt, E(t) = E_inf (1 + tau delta(t)). Not both; times above 0, ratios not below.
//                                                                          docs/theory.md (63)
struct Relaxation {
  std::vector<Branch> branches;   // tau_k and b_k, in any order
  double retardation_time = 0.0;  // s: tau = eta / E_inf of Kelvin-Voigt; 0: it is none

  [[nodiscard]] bool elastic() const { return branches.empty() && retardation_time == 0.0; }
  // E(t) / E_inf for t >= 0, s. Of Kelvin-Voigt 1: the impulse at t = 0 has no value.
  [[nodiscard]] double modulus_ratio(double time) const;
};

// J(t) E_inf = 1 - sum_m j_m exp(-t / T_m): what a unit of stress strains after the time t, over
// what it strains in the end.
struct Creep {
  std::vector<Branch> modes;  // T_m and j_m, times ascending
  // T_m - tau_k at [m n + k] without cancellation, where the n branches tau_k ascend; none for
  // Kelvin-Voigt, which has no branch.
  std::vector<double> gaps;  // s

  // J(t) E_inf for t >= 0, s.
  [[nodiscard]] double compliance_ratio(double time) const;
};

// The creep that belongs to a relaxation: as many modes as branches, T_m between tau_m and
// tau_(m+1). One branch has T = tau E_0 / E_inf. For set-up: it allocates and iterates.
//                                                      Park and Schapery 1999
[[nodiscard]] Creep creep(const Relaxation& relaxation);

// Branches in ascending order of time, those of equal times made one, those of no ratio left out.
[[nodiscard]] Relaxation sorted(const Relaxation& relaxation);

// The relaxation of the effective modulus E*(t) of an elastic finger and a relaxing tissue in
// series, over its own relaxed value 1 / (lambda_1 + lambda_2). `finger_share` in [0, 1] is the
// finger's part of the relaxed compliance, lambda_1 / (lambda_1 + lambda_2): 0 gives the tissue's
// own (`sorted`), 1 an elastic contact. A Kelvin-Voigt tissue becomes a standard linear solid. It
// holds where both bodies sink under the same pressure alike: two half-spaces, not a layer.
[[nodiscard]] Relaxation behind_finger(const Relaxation& tissue, double finger_share);

}  // namespace palpate::contact
