// How much less the surface of a layer sinks than that of a half-space, around a force.
#pragma once

#include <vector>

#include "contact/layer_integral.h"

namespace palpate::contact {

// Under a point force F the surface of a layer of thickness H sinks, at the distance r, by
//   u(r) = F / (pi E') (1/r - Gamma(r/H) / H),   E' = E / (1 - nu^2),
// where 1/r is the half-space's part. Gamma(rho) = int_0^inf M(u) J_0(u rho) du is smooth, is pi/2
// c_1 at 0, and tends to 1/rho far away, where the layer does not sink.
//                                                                    docs/theory.md [layer_surface]
class LayerSinking {
 public:
  // Tabulates Gamma from 0 to `farthest`: a fifth of a millisecond per unit; for set-up only.
  LayerSinking(const Layer& layer, double farthest);

  // 0 <= rho <= farthest; error < 1e-7 (several layers: 3e-5).
  [[nodiscard]] double gamma(double rho) const;

 private:
  struct Knot {
    double value, slope;
  };
  struct Table {
    double last_rho;
    int pieces;               // up to last_rho
    std::vector<Knot> knots;  // of those that are needed
  };
  std::vector<Table> tables_;  // for several layers a second one, farther away
};

}  // namespace palpate::contact
