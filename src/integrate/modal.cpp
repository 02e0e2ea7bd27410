// Eigenmodes once; then each step multiplies every mode by its exact propagator.
#include "integrate/modal.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace palpate::integrate {

Modal::Modal(const Body& body) : body_(&body) {
  const auto held = body.held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] == 0) free_.push_back(static_cast<Eigen::Index>(d));
  const SplitMatrix stiffness = body.stiffness();
  const auto size = static_cast<Eigen::Index>(free_.size());
  Vector scale(size);
  std::vector<Eigen::Index> position(held.size(), -1);
  for (Eigen::Index i = 0; i < size; ++i) {
    scale[i] = 1.0 / std::sqrt(body.mass()[free_[static_cast<std::size_t>(i)]]);
    position[static_cast<std::size_t>(free_[static_cast<std::size_t>(i)])] = i;
  }
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](const Eigen::SparseMatrix<double>& matrix) {
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
        const Eigen::Index i = position[static_cast<std::size_t>(entry.row())];
        const Eigen::Index j = position[static_cast<std::size_t>(entry.col())];
        if (i >= 0 && j >= 0) scaled(i, j) += entry.value() * scale[i] * scale[j];
      }
  };
  add(stiffness.local);
  if (stiffness.weights.size() > 0)
    add(stiffness.shared.transpose() * stiffness.weights.asDiagonal() * stiffness.shared);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> decomposition(scaled);
  omega_ = decomposition.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  shapes_ = scale.asDiagonal() * decomposition.eigenvectors();
}

void Modal::prepare(double time_step) {
  if (time_step == prepared_step_) return;
  prepared_step_ = time_step;
  const Proportional& p = body_->proportional();
  propagators_.resize(static_cast<std::size_t>(omega_.size()));
  for (Eigen::Index i = 0; i < omega_.size(); ++i) {
    // x = (q, q'/omega, z_1, ...): q'' + (drag + retardation omega^2) q' + omega^2 q
    //   + sum of ratio omega^2 (q - z_i) = f,  z_i' = (q - z_i) / time_i     docs/theory.md (41)
    const double omega = std::max(omega_[i], 1e-9 * omega_[omega_.size() - 1]);
    const double damping = p.drag_rate + p.retardation_time * omega * omega;
    const auto inner = static_cast<Eigen::Index>(p.branches.size());
    const Eigen::Index size = 2 + inner;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size + 2, size + 2);
    system(0, 1) = omega;
    system(1, 0) = -omega;
    system(1, 1) = -damping;
    for (Eigen::Index b = 0; b < inner; ++b) {
      const auto& branch = p.branches[static_cast<std::size_t>(b)];
      system(1, 0) -= omega * branch.ratio;
      system(1, 2 + b) = omega * branch.ratio;
      system(2 + b, 0) = 1.0 / branch.time;
      system(2 + b, 2 + b) = -1.0 / branch.time;
    }
    // The force is f0 + (f1 - f0) s with s' = 1/dt, carried as two more unknowns.
    system(1, size) = 1.0 / omega;
    system(size, size + 1) = 1.0 / time_step;
    const Eigen::MatrixXd exponent = system * time_step;
    const Eigen::MatrixXd whole = exponent.exp();
    Propagator& propagator = propagators_[static_cast<std::size_t>(i)];
    propagator.keep = whole.topLeftCorner(size, size);
    propagator.end = whole.block(0, size + 1, size, 1);
    propagator.begin = whole.block(0, size, size, 1) - propagator.end;
  }
}

Vector Modal::modal_force(const Vector& load) const {
  Vector free(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i)
    free[static_cast<Eigen::Index>(i)] = load[free_[i]];
  return shapes_.transpose() * free;
}

void Modal::begin(const State& state, double time_step, MemoryRule rule) {
  if (!started_) {
    // The modes move about the displacement of the start, which must be in balance.
    started_ = true;
    modes_.assign(static_cast<std::size_t>(omega_.size()),
                  Mode::Zero(2 + static_cast<Eigen::Index>(body_->proportional().branches.size())));
    load_before_ = Vector::Zero(omega_.size());
    settled_ = state.displacement;
  }
  time_step_ = time_step;
  held_load_ = rule == MemoryRule::held;
  prepare(time_step);
}

bool Modal::linearise(const Vector&, const Vector& load) {
  const Vector force = modal_force(load);
  Vector position(omega_.size());
  for (Eigen::Index i = 0; i < omega_.size(); ++i) {
    const Propagator& propagator = propagators_[static_cast<std::size_t>(i)];
    const double before = held_load_ ? force[i] : load_before_[i];
    position[i] = propagator.keep.row(0).dot(modes_[static_cast<std::size_t>(i)]) +
                  propagator.begin[0] * before + propagator.end[0] * force[i];
  }
  base_ = settled_;
  const Vector free = shapes_ * position;
  for (std::size_t i = 0; i < free_.size(); ++i)
    base_[free_[i]] += free[static_cast<Eigen::Index>(i)];
  return true;
}

Vector Modal::response(const Vector& load) const {
  Vector position = modal_force(load);
  for (Eigen::Index i = 0; i < position.size(); ++i)
    position[i] *= propagators_[static_cast<std::size_t>(i)].end[0];
  const Vector free = shapes_ * position;
  Vector all = Vector::Zero(body_->mass().size());
  for (std::size_t i = 0; i < free_.size(); ++i) all[free_[i]] = free[static_cast<Eigen::Index>(i)];
  return all;
}

void Modal::finish(State& state, const Vector& displacement, const Vector& load) {
  const Vector force = modal_force(load);
  Vector velocity(omega_.size());
  for (Eigen::Index i = 0; i < omega_.size(); ++i) {
    const Propagator& propagator = propagators_[static_cast<std::size_t>(i)];
    Mode& mode = modes_[static_cast<std::size_t>(i)];
    const double before = held_load_ ? force[i] : load_before_[i];
    mode = propagator.keep * mode + propagator.begin * before + propagator.end * force[i];
    velocity[i] = mode[1] * omega_[i];
  }
  load_before_ = force;
  const Vector free = shapes_ * velocity;
  for (std::size_t i = 0; i < free_.size(); ++i)
    state.velocity[free_[i]] = free[static_cast<Eigen::Index>(i)];
  body_->remember(displacement, {time_step_, MemoryRule::exact}, state.memory);
  state.displacement = displacement;
  state.time += time_step_;
}

}  // namespace palpate::integrate
