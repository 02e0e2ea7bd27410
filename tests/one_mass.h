// One mass on one spring as a body for integrators: three degrees of freedom, two of them held.
#pragma once

#include <array>

#include "integrate/body.h"

namespace palpate::test {

// m u'' + d u' + (tau k) u' + k u = F, along x.
struct OneMass final : integrate::Body {
  using Vector = integrate::Vector;

  double k = 1.0;
  double m = 1.0;
  double d = 0.0;
  double tau = 0.0;
  std::array<char, 3> held_flags{0, 1, 1};

  OneMass() { update(); }
  void update() {
    mass_vector = Vector::Constant(3, m);
    drag_vector = Vector::Constant(3, d);
    damping.drag_rate = d / m;
    damping.retardation_time = tau;
    matrix = block(k);
  }

  Vector mass_vector;
  Vector drag_vector;
  integrate::Proportional damping;
  BlockMatrix matrix;

  [[nodiscard]] const Vector& mass() const override { return mass_vector; }
  [[nodiscard]] const Vector& drag() const override { return drag_vector; }
  [[nodiscard]] std::span<const char> held() const override { return held_flags; }
  [[nodiscard]] bool linear() const override { return true; }
  [[nodiscard]] const integrate::Proportional& proportional() const override { return damping; }
  void look(integrate::State& state) const override {
    state.force = k * state.displacement;
    state.stored = 0.5 * k * state.displacement.squaredNorm();
  }
  [[nodiscard]] static BlockMatrix block(double x) {
    BlockMatrix matrix(1, {});
    matrix.add(0, 0, Vec3(x, 0.0, 0.0).asDiagonal().toDenseMatrix());
    return matrix;
  }
  [[nodiscard]] SplitMatrix diagonal(double x) const {
    SplitMatrix matrix;
    matrix.local.resize(3, 3);
    matrix.local.insert(0, 0) = x;
    matrix.local.insert(1, 1) = 1.0;
    matrix.local.insert(2, 2) = 1.0;
    return matrix;
  }
  [[nodiscard]] const BlockMatrix& stiffness() const override { return matrix; }
  [[nodiscard]] bool has_dashpots() const override { return tau > 0.0; }
  [[nodiscard]] BlockMatrix dashpots(const Vector&) const override { return block(tau * k); }
  void dashpot_force(const Vector&, const Vector& v, Vector& f) const override { f = tau * k * v; }
  using Body::memory_at;
  void memory_at(const Vector& u, std::vector<double>& memory) const override {
    memory.assign(1, u[0]);
  }
  void remember(const Vector& u, const integrate::TimeStep&,
                std::vector<double>& memory) const override {
    memory[0] = u[0];
  }
  // Dashpots by implicit Euler, which is what first_order asks for.
  void step_force(const Vector& u, std::span<const double> memory, const integrate::TimeStep& step,
                  Vector& f) const override {
    f = k * u;
    if (step.size > 0.0) f[0] += tau * k * (u[0] - memory[0]) / step.size;
  }
  [[nodiscard]] SplitMatrix step_stiffness(const Vector&, std::span<const double>,
                                           const integrate::TimeStep& step) const override {
    return diagonal(k + (step.size > 0.0 ? tau * k / step.size : 0.0));
  }
};

inline integrate::State state_at(double u, double v) {
  integrate::State state;
  state.displacement = integrate::Vector::Zero(3);
  state.velocity = integrate::Vector::Zero(3);
  state.displacement[0] = u;
  state.velocity[0] = v;
  state.memory = {u};
  return state;
}

inline integrate::Vector load_of(double force) {
  integrate::Vector load = integrate::Vector::Zero(3);
  load[0] = force;
  return load;
}

}  // namespace palpate::test
