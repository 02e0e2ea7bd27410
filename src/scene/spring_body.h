// A network of springs with its viscous law and supports, as a body for integrators.
#pragma once

#include <optional>
#include <vector>

#include "integrate/body.h"
#include "tissue/network.h"
#include "tissue/spring_loop.h"
#include "tissue/viscous.h"

namespace palpate::scene {

// All springs have one viscous law. With E the linear map from elongations to tensions, and q_k the
// elongations that the branches remember, the tensions are  E (e + sum_k b_k (e - q_k)).  Where
// springs do not turn, this is  f = K (u + sum_k b_k (u - z_k))  for the whole body, with one
// matrix and the memory z_k of its nodes.                          docs/theory.md [branches]
class SpringBody final : public integrate::Body {
 public:
  using Vector = integrate::Vector;

  // The network must outlive the body. `held` has one flag per degree of freedom. Use a body in one
  // thread only: its methods share buffers.
  SpringBody(const tissue::Network& network, tissue::Kinematics kinematics,
             const tissue::ViscousLaw& law, std::vector<char> held);

  [[nodiscard]] const tissue::Network& network() const { return *network_; }
  [[nodiscard]] const tissue::ViscousLaw& law() const { return law_; }
  [[nodiscard]] tissue::Kinematics kinematics() const { return kinematics_; }

  [[nodiscard]] const Vector& mass() const override { return mass_; }
  [[nodiscard]] const Vector& drag() const override { return drag_; }
  [[nodiscard]] std::span<const char> held() const override { return held_; }
  [[nodiscard]] bool linear() const override { return kinematics_ == tissue::Kinematics::linear; }
  [[nodiscard]] const integrate::Proportional& proportional() const override {
    return proportional_;
  }
  void look(integrate::State& state) const override;
  [[nodiscard]] const BlockMatrix& stiffness() const override;
  [[nodiscard]] bool has_dashpots() const override;
  [[nodiscard]] BlockMatrix dashpots(const Vector& displacement) const override;
  void dashpot_force(const Vector& displacement, const Vector& velocity,
                     Vector& force) const override;
  using Body::memory_at;
  void memory_at(const Vector& displacement, std::vector<double>& memory) const override;
  void remember(const Vector& displacement, const integrate::TimeStep& step,
                std::vector<double>& memory) const override;
  void step_force(const Vector& displacement, std::span<const double> memory,
                  const integrate::TimeStep& step, Vector& force) const override;
  [[nodiscard]] SplitMatrix step_stiffness(const Vector& displacement,
                                           std::span<const double> memory,
                                           const integrate::TimeStep& step) const override;

  // Copies what the branches of another body of the same law remember of number `from` of its
  // `count` numbers to number `to` of `memory`. Numbers are those of degrees of freedom or, where
  // springs turn, of springs.
  void inherit(std::span<const double> other, std::size_t count, std::size_t from, std::size_t to,
               std::vector<double>& memory) const;

  // Energies of a state, J, and the energy dissipated between two states.  docs/theory.md [balance]
  [[nodiscard]] double stored(const integrate::State& state) const;
  [[nodiscard]] double kinetic(const integrate::State& state) const;
  [[nodiscard]] double dissipated(const integrate::State& before,
                                  const integrate::State& after) const;

 private:
  void prepare(const integrate::TimeStep& step) const;
  [[nodiscard]] tissue::SpringLoop& loop() const;
  [[nodiscard]] const Vector& measure(const Vector& displacement) const;
  void respond(const Vector& measured, Vector& response) const;
  [[nodiscard]] Vector spread_mass(double factor) const;

  const tissue::Network* network_;
  tissue::Kinematics kinematics_;
  tissue::ViscousLaw law_;
  std::vector<char> held_;
  Vector mass_;
  Vector drag_;
  integrate::Proportional proportional_;
  mutable std::optional<BlockMatrix> stiffness_;      // when first needed
  mutable std::optional<tissue::SpringLoop> loop_;    // likewise
  mutable std::vector<tissue::MemoryStep> steps_;     // of a step, one per branch
  mutable Vector elongation_, tension_, difference_;  // buffers
};

}  // namespace palpate::scene
