// Semi-implicit (symplectic) Euler: the new velocity first, then the displacement with it.
#pragma once

#include "integrate/central_difference.h"

namespace palpate::integrate {

//   (M + D dt) v1 = M v0 + dt (F - f(u0)),  u1 = u0 + dt v1
// with the forces at the start of the step. First order: without damping it is a central difference
// whose velocities are taken to be half a step later than they are. Stable for
// dt omega < 2 (sqrt(1 + zeta^2) + zeta), because the damping stands in the left matrix: a product
// where that is diagonal, a sparse factorisation where dashpots join nodes.
class SemiImplicitEuler {
 public:
  SemiImplicitEuler(const Body& body, double time_step)
      : method_(body, time_step, Start::consistent, DampingVelocity::ahead) {}

  // From the state at t under the load at t to the state at t + dt.
  void step(State& state, const Vector& load) { method_.step(state, load); }

 private:
  CentralDifference method_;
};

}  // namespace palpate::integrate
