// Implicit steps as linearisations: statics, and backward differences in time.
#pragma once

#include "base/cholesky.h"
#include "integrate/body.h"

namespace palpate::integrate {

// What an implicit step offers to whoever solves a contact inside it: the displacement at the end
// of the step is  base + response(load)  for any further load, linearised about a displacement.
class Implicit {
 public:
  enum class Inertia { none, backward_difference };

  // none: quasi-static, exact viscous memory, second order in smooth courses of load.
  // backward_difference: implicit Euler, first order, stable for every step.
  Implicit(const Body& body, Inertia inertia) : body_(&body), inertia_(inertia) {}

  // Starts a step from `state`, which must stay as it is until finish(). `rule` counts only
  // without inertia: implicit Euler has its own.
  void begin(const State& state, double time_step, MemoryRule rule);

  // Linearises about `displacement` under `load` (N). Returns false where the matrix cannot be
  // factored (the body has become unstable); then nothing else may be called.
  [[nodiscard]] bool linearise(const Vector& displacement, const Vector& load);
  [[nodiscard]] const Vector& base() const { return base_; }
  [[nodiscard]] Vector response(const Vector& load) const;
  void response(const Vector& load, Vector& moved) const;  // the same; two vectors

  // Ends the step at `displacement`. `load` is the whole load at its end, N.
  void finish(State& state, const Vector& displacement, const Vector& load);

 private:
  const Body* body_;
  Inertia inertia_;
  const State* state_ = nullptr;
  TimeStep step_;
  TimeStep factored_;
  bool has_factors_ = false;
  Cholesky factors_;
  Vector base_;
  Vector force_;
  Vector residual_;
  Vector moved_;
};

}  // namespace palpate::integrate
