// How much less a layer sinks than a half-space, at any distance from a force on it.
#pragma once

#include <vector>

#include "contact/layer_integral.h"

namespace palpate::contact {

// Under a point force F the surface of a layer of thickness H sinks at the distance r by
//   u(r) = F / (pi E') (1/r - Gamma(r/H) / H),   E' = E / (1 - nu^2),
// 1/r being the half-space's. Gamma(rho) = int_0^inf M(u) J_0(u rho) du is smooth, pi/2 c_1 at 0,
// and nears 1/rho where the layer no longer sinks.                            docs/theory.md (60)
class LayerSinking {
 public:
  // Tabulates Gamma; for set-up.
  explicit LayerSinking(const Layer& layer);

  [[nodiscard]] double gamma(double rho) const;  // rho >= 0, within 1e-7, of several layers 3e-5

 private:
  struct Knot {
    double value, slope;
  };
  struct Table {
    double last_rho;
    std::vector<Knot> knots;
  };
  std::vector<Table> tables_;  // near the force, and, of several layers, far from it; then 1/rho
};

}  // namespace palpate::contact
