// A linear body in modal coordinates: exact in time for loads that change linearly in a step.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "integrate/body.h"

namespace palpate::integrate {

// Offers the same calls as Implicit: the end of a step is base + response(load).
class Modal {
 public:
  // Decomposes K phi = omega^2 M phi of the body about rest (dense: time grows with the cube of
  // the degrees of freedom). The body must be linear, its damping proportional.
  explicit Modal(const Body& body);

  // `rule` `held` says that the load jumped to its end value at the start of the step.
  void begin(const State& state, double time_step, MemoryRule rule);
  [[nodiscard]] bool linearise(const Vector& displacement, const Vector& load);
  [[nodiscard]] const Vector& base() const { return base_; }
  [[nodiscard]] Vector response(const Vector& load) const;
  void finish(State& state, const Vector& displacement, const Vector& load);

  [[nodiscard]] const Vector& frequencies() const { return omega_; }  // 1/s, ascending

 private:
  // One mode's position, velocity over omega, and inner position of every viscous branch.
  using Mode = Eigen::VectorXd;
  struct Propagator {
    Eigen::MatrixXd keep;
    Mode begin;  // per modal force at the start of the step
    Mode end;    // per modal force at its end
  };

  void prepare(double time_step);
  [[nodiscard]] Vector modal_force(const Vector& load) const;

  const Body* body_;
  Vector omega_;
  Eigen::MatrixXd shapes_;  // columns phi with phi^T M phi = 1, rows only of free freedoms
  std::vector<Eigen::Index> free_;
  std::vector<Propagator> propagators_;
  double prepared_step_ = -1.0;
  std::vector<Mode> modes_;
  Vector load_before_;  // modal force at the start of the step
  bool started_ = false;
  bool held_load_ = false;
  double time_step_ = 0.0;
  Vector settled_;  // the displacement that the modes move about
  Vector base_;
};

}  // namespace palpate::integrate
