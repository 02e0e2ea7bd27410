// Semi-implicit (symplectic) Euler: first the new velocity, then the displacement with it.
#pragma once

#include "integrate/central_difference.h"

namespace palpate::integrate {

//   (M + D dt) v1 = M v0 + dt (F - f(u0)),  u1 = u0 + dt v1
// with the forces at the start of the step. It is of first order: without damping it is a central
// difference whose velocities are assigned to a time half a step too late. It is stable for
// dt omega < 2 (sqrt(1 + zeta^2) + zeta), because the damping is in the matrix on the left, which
// is inverted as that of CentralDifference.                         docs/theory.md (80), (81)
class SemiImplicitEuler {
 public:
  SemiImplicitEuler(const Body& body, double time_step)
      : method_(body, time_step, Start::consistent, DampingVelocity::ahead) {}

  // Advances the state from t to t + dt under the load (N) at t.
  void step(State& state, const Vector& load) { method_.step(state, load); }

 private:
  CentralDifference method_;
};

}  // namespace palpate::integrate
