// A network of springs with its viscous law and supports, as a body for integrators.
#pragma once

#include <optional>
#include <vector>

#include "integrate/body.h"
#include "tissue/energy.h"
#include "tissue/fast_springs.h"
#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::scene {

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
  void force(const Vector& displacement, std::span<const double> memory,
             Vector& force) const override;
  [[nodiscard]] SplitMatrix stiffness() const override;
  [[nodiscard]] bool has_dashpots() const override;
  [[nodiscard]] SplitMatrix dashpots(const Vector& displacement) const override;
  [[nodiscard]] BlockMatrix dashpot_blocks(const Vector& displacement) const override;
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

  // Copies the branches' memory of spring `from` in `other`, the memory of another body, to spring
  // `to` in `memory`; the elongation there does not change.
  void inherit(std::span<const double> other, std::size_t from, std::size_t to,
               std::vector<double>& memory) const;

  // Energies of a state, J, and the energy dissipated between two states. They are fast if the
  // body's last call was remember() to that state, from `before`.
  [[nodiscard]] double stored(const integrate::State& state) const;
  [[nodiscard]] double kinetic(const integrate::State& state) const;
  [[nodiscard]] double dissipated(const integrate::State& before,
                                  const integrate::State& after) const;

 private:
  void prepare(const integrate::TimeStep& step) const;
  [[nodiscard]] tissue::FastSprings& fast() const;
  [[nodiscard]] Vector spread_mass(double factor) const;

  const tissue::Network* network_;
  tissue::Kinematics kinematics_;
  tissue::ViscousLaw law_;
  std::vector<char> held_;
  Vector mass_;
  Vector drag_;
  integrate::Proportional proportional_;
  // At the displacement that was requested last; statics alone do not need it.
  mutable std::optional<tissue::FastSprings> fast_;
  mutable std::optional<tissue::FastSprings> dashpots_;  // of Kelvin-Voigt, applied to velocities
  mutable Vector turned_at_;                             // m, displacement of their directions
  mutable std::vector<double> elongation_;
  mutable std::vector<double> tension_;
  mutable std::vector<double> effective_;
  mutable std::vector<double> memory_at_;  // a buffer of dashpot_force()
  mutable tissue::EnergyScratch scratch_;
  mutable std::optional<integrate::TimeStep> prepared_;
  mutable std::vector<tissue::MemoryStep> steps_;  // of `prepared_`
};

}  // namespace palpate::scene
