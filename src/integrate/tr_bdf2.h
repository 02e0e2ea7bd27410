// The trapezoidal rule and then a backward difference of second order: TR-BDF2.
#pragma once

#include "integrate/implicit.h"

namespace palpate::integrate {

// Second order and L-stable: what is too fast for the step is gone after it. A step has two stages:
// trapezoidal to t + gamma dt, and from both that and the start a backward difference to t + dt.
// With gamma = 2 - sqrt(2) each is an implicit Euler step of gamma dt / 2 from another past, so
// that they share one matrix.
//          R. E. Bank and others, IEEE Trans. CAD 4(4), 1985; docs/theory.md (83)
//
// Offers the calls of Implicit for each stage in turn: begin() ... finish() twice make a step, and
// contacts are solved in both, because a load that is only interpolated in between would make
// stiff contacts swing.
class TrBdf2 {
 public:
  // The part of a step where its first stage ends, gamma; rounded, and the second stage with it.
  static constexpr double first_part = 0.58578643762690495;

  explicit TrBdf2(const Body& body) : body_(&body), euler_(body, inertia) {}

  // The load (N) at the start of the next step; before the first stage of every step.
  void start_under(const Vector& load) { load_ = load; }

  // Starts a stage of a step of `time_step` (s) from `state`: the first one from that of t, the
  // second from what the first left. The rule of the memory does not count.
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
  State start_;                  // of the step
  State past_;                   // that the stage's Euler step starts from
  Vector load_;                  // N, at the start of the step
  Vector force_, acceleration_;  // of extrapolate(), as the next three
  Vector behind_;
  std::vector<double> memory_ahead_, memory_behind_;
  double time_step_ = 0.0;
  bool second_ = false;
};

}  // namespace palpate::integrate
