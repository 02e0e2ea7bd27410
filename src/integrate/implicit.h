// Implicit steps in linearised form: quasi-statics and backward differences in time.
#pragma once

#include <vector>

#include "base/cholesky.h"
#include "integrate/body.h"
#include "tissue/viscous.h"

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

// TR-BDF2: the trapezoidal rule followed by a backward difference of second order.
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

// The load whose elastic static solution equals the displacement of a viscous mesh without inertia.
// All springs relax by the same function, so that K (1 + sum b_k) u - K sum b_k q_k = L has the
// solution u = K^-1 J[L], where J[L] is the creep of L, degree of freedom by degree of freedom.
// With Kelvin-Voigt's dashpots J[L] obeys tau J' + J = L, and in elastic bodies it is L.
//                                           docs/theory.md, inertia in the contact; [branches]
class EquivalentLoad {
 public:
  // `rule` is the memory rule of the mesh; any other than `first_order` is taken as `exact`.
  EquivalentLoad(const tissue::ViscousLaw& law, MemoryRule rule) : law_(law), rule_(rule) {}

  // Sets the size of the next steps, s.
  void set_step(double time_step);

  // Advances by one step, at the end of which the load is `load` (N).
  void pass(const Vector& load);

  // J[L] at the end of the last step, N; empty before the first one.
  [[nodiscard]] const Vector& load() const { return load_; }

  // Renumbers: entry d of the new vectors is entry from[d] of the old ones, or 0 where that is -1.
  void renumber(const std::vector<Eigen::Index>& from);

 private:
  tissue::ViscousLaw law_;
  MemoryRule rule_;
  std::vector<tissue::MemoryStep> steps_;
  Vector load_;                 // J[L]
  std::vector<Vector> memory_;  // N, one per branch; of Kelvin-Voigt the load
  Vector right_;                // N
};

}  // namespace palpate::integrate
