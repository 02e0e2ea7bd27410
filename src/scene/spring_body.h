// A network of springs with its viscous law and supports, as integrators see it.
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

  // The network must outlive the body. `held` has one flag a degree of freedom. One body serves
  // one thread: its methods share scratch space.
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

  // Spring `to` of `memory` takes over what spring `from` of another body remembers beyond its
  // elongation.
  void inherit(std::span<const double> other, std::size_t from, std::size_t to,
               std::vector<double>& memory) const;

  // Energies of a state, J, and what was lost on the way from one state to the next: at hand, and
  // cheap, where the body's last call was remember() from the one displacement to the other.
  [[nodiscard]] double stored(const integrate::State& state) const;
  [[nodiscard]] double kinetic(const integrate::State& state) const;
  [[nodiscard]] double dissipated(const integrate::State& before,
                                  const integrate::State& after) const;

 private:
  void prepare(const integrate::TimeStep& step) const;
  [[nodiscard]] Vector spread_mass(double factor) const;

  const tissue::Network* network_;
  tissue::Kinematics kinematics_;
  tissue::ViscousLaw law_;
  std::vector<char> held_;
  Vector mass_;
  Vector drag_;
  integrate::Proportional proportional_;
  mutable tissue::FastSprings fast_;  // of the last displacement that was asked for
  mutable std::optional<tissue::FastSprings> dashpots_;  // of Kelvin-Voigt, by velocities
  mutable Vector turned_at_;                             // displacement of their directions, m
  mutable std::vector<double> elongation_;
  mutable std::vector<double> tension_;
  mutable std::vector<double> effective_;
  mutable std::vector<double> memory_at_;  // the displacement of dashpots that turn
  mutable tissue::EnergyScratch scratch_;
  mutable std::optional<integrate::TimeStep> prepared_;
  mutable std::vector<tissue::MemoryStep> steps_;  // of `prepared_`
};

}  // namespace palpate::scene
