// A linear body in modal coordinates: exact in time for loads that change linearly in a step.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/symmetric_solver.h"
#include "integrate/body.h"

namespace palpate::integrate {

// All modes of the body for which they were found last, so that a body that is run again, as for a
// chart's reference, is not solved again. Not thread-safe.
struct KnownModes {
  Eigen::MatrixXd matrix;   // 1/s^2, M^(-1/2) K M^(-1/2) of the free degrees of freedom
  Vector squares;           // 1/s^2, its eigenvalues
  Eigen::MatrixXd vectors;  // its eigenvectors, in columns
  double seconds = 0.0;     // that finding these took
  double saved = 0.0;       // s, in all, by not finding them again
};

// Has the same interface as Implicit: the displacement at the end of a step is base +
// response(load). If the load is known in advance, press() and pass() advance the modes alone, and
// show() computes the displacement when it is needed.                docs/theory.md [modes]
//
// Where only the lowest modes are kept, all displacements, velocities and energies here are those
// of these modes; dropped() is the static displacement of the others.
//                                                                     docs/theory.md [lowest_modes]
class Modal {
 public:
  // Solves K phi = omega^2 M phi for all modes of the body at rest by a dense solver, whose time
  // grows with the cube of the degrees of freedom, unless `known` has them. The body must be linear
  // and its damping proportional.
  explicit Modal(const Body& body, KnownModes* known = nullptr);
  // Keeps the `most` lowest modes (1 or more), found by Lanczos iterations on the inverse of K.
  // `statics` must be prepared for K and the body's held degrees of freedom, and outlive this.
  // Throws MeshError if K is not positive definite.
  Modal(const Body& body, Eigen::Index most, SymmetricSolver& statics, KnownModes* known = nullptr);

  [[nodiscard]] bool keeps_all() const {
    return omega_.size() == static_cast<Eigen::Index>(free_.size());
  }
  [[nodiscard]] Eigen::Index modes() const { return omega_.size(); }
  [[nodiscard]] double highest() const { return omega_[omega_.size() - 1]; }  // 1/s, of those kept
  // The static displacement (m) under `load` (N) of the modes that are used, and of the others.
  void kept(const Vector& load, Vector& moved) const;
  void dropped(const Vector& load, Vector& moved) const;

  // The rule `held` means that the load jumps to its final value at the start of the step.
  void begin(const State& state, double time_step, MemoryRule rule);
  [[nodiscard]] bool linearise(const Vector& displacement, const Vector& load);
  [[nodiscard]] const Vector& base() const { return base_; }
  void response(const Vector& load, Vector& moved) const;
  void finish(State& state, const Vector& displacement, const Vector& load);

  // Steps in the modes alone, for bodies whose damping has no branches: press() adds the load (N)
  // of one degree of freedom at the end of the next step (others are zero); pass() takes the step.
  [[nodiscard]] bool passes_alone() const { return body_->proportional().branches.empty(); }
  void press(Eigen::Index freedom, double load);
  void pass(const State& start, double time_step);

  // Displacement and velocity after pass(); the memory is that of a body at rest in this position.
  void show(State& state) const;

  // Energies of the steps by pass(), J.
  struct Energies {
    double work = 0.0;
    double lost = 0.0;
    double held = 0.0;  // stored and kinetic energy at present
  };
  [[nodiscard]] Energies energies() const;

 private:
  // The state of a mode is its position q, q'/omega, and the inner position of every viscous
  // branch; every component is a vector over the modes.
  struct Propagators {
    std::vector<std::vector<Vector>> keep;
    std::vector<Vector> begin;  // change per modal force at the start of the step
    std::vector<Vector> end;    // change per modal force at its end
    Vector damping;             // 1/s^2, for pass()
  };
  using Shapes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void find_free();
  void find_all(KnownModes* known);
  void find_lowest(Eigen::Index count);
  void start(const State& state);
  void prepare(double time_step);
  void modal_force(const Vector& load, Vector& sum) const;
  void next(std::size_t component, const Vector& before, const Vector& after, Vector& sum) const;
  void add_shapes(const Vector& amplitudes, Vector& all) const;

  const Body* body_;
  SymmetricSolver* statics_;  // null if all modes are kept
  Vector omega_;              // 1/s, the modes' angular frequencies, ascending
  Shapes shapes_;  // columns phi with phi^T M phi = 1, rows of the free degrees of freedom
  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> row_;  // of every degree of freedom; -1 where held
  Propagators propagators_;
  double prepared_step_ = -1.0;
  std::vector<Vector> modes_;  // components as in Propagators
  Vector load_before_;         // modal force at the start of the step
  Vector load_after_;          // modal force at its end, as added up by press()
  Vector work_, lost_;         // J, of every mode
  bool started_ = false;
  bool held_load_ = false;
  double time_step_ = 0.0;
  Vector settled_;  // m, the displacement about which the modes move
  Vector base_;
  mutable Vector force_, amplitudes_;  // of the modes
  std::vector<Vector> modes_after_;
};

}  // namespace palpate::integrate
