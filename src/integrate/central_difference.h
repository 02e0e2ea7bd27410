// Central differences: eq. (12) of Chen 2007.
#pragma once

#include "base/symmetric_solver.h"
#include "integrate/body.h"

namespace palpate::integrate {

// The first step. paper: U(-dt) = U(0), first order. consistent: second order; without damping it
// is U(-dt) = U0 - dt V0 + dt^2 A0 / 2; under heavy damping, where that formula would overshoot, it
// is the trapezoidal rule.                                          docs/theory.md [first_step]
enum class Start { consistent, paper };

// The velocity with which drag and dashpots act in a step: the mean of this step's and the previous
// step's (eq. 12), the previous step's, or this step's. The last two are of order 1. `ahead` is
// semi-implicit Euler,
//   (M + D dt) v1 = M v0 + dt (F - f(u0)),  u1 = u0 + dt v1,
// without damping a central difference whose velocities are assigned to a time half a step too
// late.
//                                                               docs/theory.md [semi_implicit]
enum class DampingVelocity { centred, lagged, ahead };

// The fastest mode of a body.
struct FastestMode {
  double squared = 0.0;  // 1/s^2, omega^2
  double rate = 0.0;     // 1/s, 2 zeta omega, of the damping in the integrator's equation
  double forces = 0.0;   // 1/s, of dashpots outside it, with the rate of the step before
};

// The time step (s) below which such an explicit method is stable. With w = omega dt
//   centred: w < 2
//   lagged:  w < 2 (sqrt(1 + zeta^2) - zeta)
//   ahead:   w < 2 (sqrt(1 + zeta^2) + zeta)
// At the limit a mode changes its sign in each step, u_n = (-1)^n:
//   dt^2 omega^2 + dt (forces +- 2 rate) = 4  docs/theory.md [explicit_limit]
[[nodiscard]] double explicit_limit(DampingVelocity velocity, const FastestMode& mode);

// The integrator is of second order. With a centred velocity it is stable for dt < 2 / omega_max
// with any damping, because mass, drag and dashpots are in the matrix on the left. It is inverted
// by division if it is diagonal, and by a SymmetricSolver if dashpots join nodes. If these rotate
// with the body, that solver is a preconditioner, which is renewed after a step that needs more
// than a dozen iterations.                                        docs/theory.md [central]
class CentralDifference {
 public:
  CentralDifference(const Body& body, double time_step, Start start,
                    DampingVelocity velocity = DampingVelocity::centred);

  // Advances the state from t to t + dt under the load (N) at t. The resulting velocity is the mean
  // over the step.
  void step(State& state, const Vector& load);

 private:
  void solve_dashpots(const State& state, double lag);
  void solve_turned(const Vector& displacement);

  const Body* body_;
  double time_step_;
  Start start_;
  DampingVelocity velocity_;
  double left_rate_;   // s, the factor of D in the matrix on the left
  double right_rate_;  // s, the factor of D on the right
  bool first_ = true;
  bool prepared_ = false;
  Vector before_;           // u(t) - u(t - dt)
  Vector earlier_;          // the same one step before, if the dashpots' equations are iterated
  Vector diagonal_;         // 2 M + left_rate_ D, with D the drag alone
  Vector inverse_;          // of the diagonal; 0 where held
  Vector keep_;             // 2 M - right_rate_ D, with D the drag alone
  Vector keep_first_;       // the same for a consistent first step
  SymmetricSolver solver_;  // of the matrix on the left, if dashpots join nodes
  GradientVectors vectors_;
  Vector right_;
  Vector image_;  // product of a vector with D
};

}  // namespace palpate::integrate
