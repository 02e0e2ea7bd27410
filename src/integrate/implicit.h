// Implicit steps in linearised form: quasi-statics and backward differences in time.
#pragma once

#include "base/cholesky.h"
#include "integrate/body.h"

namespace palpate::integrate {

// A step of [implicit] for callers that solve a contact in it: linearised about a displacement,
// the displacement at the end of the step is  base + response(load)  for any additional load (N).
class Implicit {
 public:
  enum class Inertia { none, backward_difference };

  // none: quasi-static; with MemoryRule::exact of second order for loads that are smooth in time.
  // backward_difference: implicit Euler, of first order, stable for every step.
  Implicit(const Body& body, Inertia inertia) : body_(&body), inertia_(inertia) {}

  // Starts a step from `state`, which must not change until finish(). `rule` is used only without
  // inertia; with inertia the rule is first_order.
  void begin(const State& state, double time_step, MemoryRule rule);

  // Linearises about `displacement` under `load` (N). Returns false if the matrix cannot be
  // factored (the body has become unstable); then no other function may be called.
  [[nodiscard]] bool linearise(const Vector& displacement, const Vector& load);
  [[nodiscard]] const Vector& base() const { return base_; }
  [[nodiscard]] Vector response(const Vector& load) const;
  void response(const Vector& load, Vector& moved) const;  // the same, into another vector

  // Ends the step at `displacement` under the whole load (N) at its end.
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
