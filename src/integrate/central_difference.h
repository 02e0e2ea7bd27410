// Central differences: eq. (12) of Chen 2007.
#pragma once

#include "integrate/body.h"
#include "integrate/panel_factors.h"

namespace palpate::integrate {

// How the first step begins. paper: U(-dt) = U(0), first order. consistent: second order; without
// damping it is U(-dt) = U0 - dt V0 + dt^2 A0 / 2, and under heavy damping, where that would throw
// the body, it is the trapezoidal rule.                                  docs/theory.md (39)
enum class Start { consistent, paper };

// Second order; stable for dt < 2 / omega_max whatever the damping, because mass, drag and
// dashpots stand in the left matrix: a product where that is diagonal, a sparse factorisation where
// dashpots join nodes, made once. Where they turn with the body it is a preconditioner, made again
// when they have turned so far that a step needs more than a dozen iterations.
class CentralDifference {
 public:
  CentralDifference(const Body& body, double time_step, Start start);

  // The next step is a first one: the load may have jumped.
  void restart() { first_ = true; }

  // From the state at t under the load at t to the state at t + dt. The velocity it leaves is the
  // mean over the step.
  void step(State& state, const Vector& load);

 private:
  void factor(const Vector& displacement);
  void solve_dashpots(const State& state, bool consistent);
  void solve_turned(const Vector& displacement);

  const Body* body_;
  double time_step_;
  Start start_;
  bool first_ = true;
  bool has_factors_ = false;
  Vector before_;         // u(t) - u(t - dt)
  Vector diagonal_;       // 2 M + D dt, where no dashpots are
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
