// A specimen that its platens keep from widening.
#pragma once

namespace palpate::contact {

// How much stiffer that makes it: of incompressible material 1 + 2 S^2 (Gent and Lindley 1959,
// Proc. Inst. Mech. Eng. 173), S its loaded over its free surface, and of other material this in
// series with the modulus of uniaxial strain. Within 15 % of solutions by refined meshes.
//                                                  docs/theory.md [bonded] and below [compression]
[[nodiscard]] inline double bonded_stiffening(double shape_factor, double poisson_ratio = 0.5) {
  const double nu = poisson_ratio;
  const double free = 2.0 * shape_factor * shape_factor;
  const double over_confined = (1.0 + nu) * (1.0 - 2.0 * nu) / (2.0 * nu * nu);  // 1 / (M/E - 1)
  return nu > 0.0 ? 1.0 + free / (1.0 + free * over_confined) : 1.0;
}

}  // namespace palpate::contact
