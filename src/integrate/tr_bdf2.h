// TR-BDF2: the trapezoidal rule followed by a backward difference of second order.
#pragma once

#include "integrate/implicit.h"

namespace palpate::integrate {

// The method is of second order and L-stable: modes too fast for the step vanish after one step. A
// step has two stages: the trapezoidal rule to t + gamma dt, and a backward difference from t and
// t + gamma dt to t + dt. With gamma = 2 - sqrt(2), both are implicit Euler steps of length
// gamma dt / 2 from different past values, and share one matrix.
//     R. E. Bank and others, IEEE Trans. CAD 4(4), 1985; docs/theory.md [tr_bdf2]
//
// Each stage has the interface of Implicit: a step is begin() ... finish() twice. Contacts are
// solved in both stages, because stiff contacts oscillate if the load is only interpolated at
// t + gamma dt.
class TrBdf2 {
 public:
  // gamma, rounded: the part of a step after which its first stage ends. Both stages use this one.
  static constexpr double first_part = 0.58578643762690495;

  explicit TrBdf2(const Body& body) : body_(&body), euler_(body, inertia) {}

  // Sets the load (N) at the start of the next step; call it before the first stage of every step.
  void start_under(const Vector& load) { load_ = load; }

  // Starts a stage of a step of `time_step` (s): the first stage from the state at t, the second
  // one from the result of the first. The memory rule is ignored.
  void begin(const State& state, double time_step, MemoryRule rule);
  [[nodiscard]] bool linearise(const Vector& displacement, const Vector& load) {
    return euler_.linearise(displacement, load);
  }
  [[nodiscard]] const Vector& base() const { return euler_.base(); }
  [[nodiscard]] Vector response(const Vector& load) const { return euler_.response(load); }
  void response(const Vector& load, Vector& moved) const { euler_.response(load, moved); }

  // Ends the stage at `displacement` under `load` (N).
  void finish(State& state, const Vector& displacement, const Vector& load);

 private:
  static constexpr Implicit::Inertia inertia = Implicit::Inertia::backward_difference;
  void extrapolate(const State& state, double time);

  const Body* body_;
  Implicit euler_;
  State start_;                  // at the start of the step
  State past_;                   // from which the Euler step of the stage starts
  Vector load_;                  // N, at the start of the step
  Vector force_, acceleration_;  // buffers of extrapolate(), like the next three
  Vector behind_;
  std::vector<double> memory_ahead_, memory_behind_;
  double time_step_ = 0.0;
  bool second_ = false;
};

}  // namespace palpate::integrate
