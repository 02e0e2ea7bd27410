// Central differences: eq. (12) of Chen 2007.
#pragma once

#include "integrate/body.h"
#include "integrate/panel_factors.h"

namespace palpate::integrate {

// How the first step begins. paper: U(-dt) = U(0), first order. consistent: second order; without
// damping it is U(-dt) = U0 - dt V0 + dt^2 A0 / 2, and under heavy damping, where that would throw
// the body, it is the trapezoidal rule.                                  docs/theory.md (39)
enum class Start { consistent, paper };

// The velocity that drag and dashpots take in a step: the mean of its own and that of the step
// before (eq. 12), that of the step before, or its own. The last two are of first order.
enum class DampingVelocity { centred, lagged, ahead };

// The fastest motion of a body.
struct FastestMode {
  double squared = 0.0;  // 1/s^2, omega^2
  double rate = 0.0;     // 1/s, 2 zeta omega, of the damping that the method knows
  double forces = 0.0;   // 1/s, of dashpots outside it, whose forces act in the step after
};

// The step below which such an explicit method is stable, s. With w = omega dt
//   centred: w < 2
//   lagged:  w < 2 (sqrt(1 + zeta^2) - zeta)
//   ahead:   w < 2 (sqrt(1 + zeta^2) + zeta)
// where a mode turns over, u_n = (-1)^n:
//   dt^2 omega^2 + dt (forces +- 2 rate) = 4       docs/theory.md (81)
[[nodiscard]] double explicit_limit(DampingVelocity velocity, const FastestMode& mode);

// Second order; with a centred velocity stable for dt < 2 / omega_max whatever the damping, because
// mass, drag and dashpots stand in the left matrix: a product where that is diagonal, a sparse
// factorisation where dashpots join nodes, made once. Where they turn with the body it is a
// preconditioner, made again when they have turned so far that a step needs more than a dozen
// iterations.
class CentralDifference {
 public:
  CentralDifference(const Body& body, double time_step, Start start,
                    DampingVelocity velocity = DampingVelocity::centred);

  // From the state at t under the load at t to the state at t + dt. The velocity it leaves is the
  // mean over the step.
  void step(State& state, const Vector& load);

 private:
  void factor(const Vector& displacement);
  void solve_dashpots(const State& state, double lag);
  void solve_turned(const Vector& displacement);

  const Body* body_;
  double time_step_;
  Start start_;
  DampingVelocity velocity_;
  double left_rate_;   // s, times D in the left matrix
  double right_rate_;  // s, times D on the right
  bool first_ = true;
  bool has_factors_ = false;
  Vector before_;         // u(t) - u(t - dt)
  Vector diagonal_;       // 2 M + D dt, where no dashpots are, the velocity being centred
  Vector inverse_;        // of the diagonal; 0 where held
  Vector keep_;           // 2 M - D dt, and of a consistent first step:
  Vector keep_first_;     // 2 M
  PanelFactors factors_;  // of 2 M + D dt
  Vector force_;
  Vector right_;
  Vector image_;     // of a vector under D or under 2 M + D dt
  Vector residual_;  // of conjugate gradients, as the next two
  Vector refined_;   // factors_ applied to it
  Vector direction_;
};

}  // namespace palpate::integrate
