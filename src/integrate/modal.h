// A linear body in modal coordinates: exact in time for loads that change linearly in a step.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "integrate/body.h"

namespace palpate::integrate {

// Offers the same calls as Implicit: the end of a step is base + response(load). Where the load is
// known, press() and pass() take the modes through a step alone, and show() tells where the body
// is.
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
  void response(const Vector& load, Vector& moved) const;  // the same; two vectors
  void finish(State& state, const Vector& displacement, const Vector& load);

  // Frames without the body: the load (N) at a frame's end is given freedom by freedom, what is not
  // given is not loaded. Of bodies whose damping has no inner branches.
  [[nodiscard]] bool passes_alone() const { return body_->proportional().branches.empty(); }
  void press(Eigen::Index freedom, double load);
  void pass(const State& start, double time_step);

  // The body's displacement and velocity after pass(); the memory is that of a body at rest there.
  void show(State& state) const;

  // Of all frames that pass() has taken, J.
  struct Energies {
    double work = 0.0;
    double lost = 0.0;
    double held = 0.0;  // stored and kinetic, now
  };
  [[nodiscard]] Energies energies() const;

  [[nodiscard]] const Vector& frequencies() const { return omega_; }  // 1/s, ascending

 private:
  // A mode's position, velocity over omega, and inner position of every viscous branch: one vector
  // each over the modes.
  struct Propagators {
    std::vector<std::vector<Vector>> keep;
    std::vector<Vector> begin;  // per modal force at the start of the step
    std::vector<Vector> end;    // per modal force at its end
    Vector damping;             // 1/s^2, of pass()
  };
  using Shapes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void start(const State& state);
  void prepare(double time_step);
  void modal_force(const Vector& load, Vector& sum) const;
  void next(std::size_t component, const Vector& before, const Vector& after, Vector& sum) const;
  void add_shapes(const Vector& amplitudes, Vector& all) const;

  const Body* body_;
  Vector omega_;
  Shapes shapes_;  // columns phi with phi^T M phi = 1, rows only of free freedoms
  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> row_;  // of every freedom; -1 where held
  Propagators propagators_;
  double prepared_step_ = -1.0;
  std::vector<Vector> modes_;  // as Propagators
  Vector load_before_;         // modal force at the start of the step
  Vector load_after_;          // what press() has gathered
  Vector work_, lost_;         // J, of every mode
  bool started_ = false;
  bool held_load_ = false;
  double time_step_ = 0.0;
  Vector settled_;  // the displacement that the modes move about
  Vector base_;
  mutable Vector force_, amplitudes_;  // of the modes
  std::vector<Vector> modes_after_;
};

}  // namespace palpate::integrate
