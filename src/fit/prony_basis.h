// The terms of a Prony series under the loading history of a test.
#pragma once

#include <span>
#include <vector>

namespace palpate::fit {

// Strain (relaxation) or stress (creep) over time, as a share of its largest value.
struct LoadingHistory {
  double ramp = 0.0;  // duration of a ramp at constant rate from 0; 0: a step
  std::vector<double>
      samples;  // one per point, linear between them and 0 before; instead of a ramp

  [[nodiscard]] bool step() const { return ramp == 0.0 && samples.empty(); }
};

// One term at all points and its derivative with respect to ln tau.
struct BasisColumn {
  std::vector<double> value, slope;
};

// phi(t) = integral from 0 to t of e^(-(t-s)/tau) dH/ds ds, Boltzmann's superposition of the
// history H, for the times `t` in ascending order from the start of the loading. Step: e^(-t/tau).
// Ramp of duration T: tau/T (1 - e^(-t/tau)), and from T on tau/T (e^(-(t-T)/tau) - e^(-t/tau)).
//                                                                            docs/theory.md [ramp]
[[nodiscard]] BasisColumn relaxing(std::span<const double> t, double tau,
                                   const LoadingHistory& history);

// H at the times: 1 for a step.
[[nodiscard]] std::vector<double> loading(std::span<const double> t, const LoadingHistory& history);

}  // namespace palpate::fit
