// Implements the integrators' body with the loops over springs.
#include "scene/spring_body.h"

#include <algorithm>
#include <utility>

#include "tissue/fast_vectors.h"

namespace palpate::scene {

using tissue::MemoryStep;
using tissue::Viscosity;

SpringBody::SpringBody(const tissue::Network& network, tissue::Kinematics kinematics,
                       const tissue::ViscousLaw& law, std::vector<char> held)
    : network_(&network),
      kinematics_(kinematics),
      law_(law),
      held_(std::move(held)),
      elongation_(network.ends.size()),
      tension_(network.ends.size()),
      effective_(network.ends.size()) {
  mass_ = spread_mass(1.0);
  steps_.reserve(1 + law.branches.size());
  for (auto* values : {&scratch_.elongation, &scratch_.along, &scratch_.tension})
    values->reserve(network.ends.size());
  drag_ = spread_mass(law.kind == Viscosity::nodal_drag ? law.drag : 0.0);
  if (law.kind == Viscosity::nodal_drag) proportional_.drag_rate = law.drag;
  if (law.kind == Viscosity::kelvin_voigt) proportional_.retardation_time = law.time;
  for (const tissue::Branch& branch : law.branches)
    proportional_.branches.push_back({branch.time, branch.ratio});
}

integrate::Vector SpringBody::spread_mass(double factor) const {
  Vector vector(3 * network_->nodes());
  for (Eigen::Index d = 0; d < vector.size(); ++d)
    vector[d] = factor * network_->node_mass[as_index(d / 3)];
  return vector;
}

// Sets the memory coefficients of every branch (or of Kelvin-Voigt) for such a step.
void SpringBody::prepare(const integrate::TimeStep& step) const {
  if (prepared_ && *prepared_ == step) return;
  prepared_ = step;
  const auto passage = [&](double time) {
    if (step.size <= 0.0) return MemoryStep::at_once();
    switch (step.rule) {
      case integrate::MemoryRule::exact: return MemoryStep::exact(step.size, time);
      case integrate::MemoryRule::held: return MemoryStep::held(step.size, time);
      case integrate::MemoryRule::first_order: return MemoryStep::first_order(step.size, time);
      case integrate::MemoryRule::forward: return MemoryStep::forward(step.size, time);
      case integrate::MemoryRule::at_once: break;
    }
    return MemoryStep::at_once();
  };
  steps_.clear();
  if (law_.kind == Viscosity::kelvin_voigt) steps_.push_back(passage(law_.time));
  for (const tissue::Branch& branch : law_.branches) steps_.push_back(passage(branch.time));
}

tissue::FastSprings& SpringBody::fast() const {
  if (!fast_) fast_.emplace(*network_, kinematics_, law_);
  return *fast_;
}

void SpringBody::force(const Vector& displacement, std::span<const double> memory,
                       Vector& force) const {
  if (!fast().knows(displacement, memory)) fast().look(displacement, memory);
  fast().force(force);
}

SplitMatrix SpringBody::stiffness() const {
  return tissue::stiffness_matrix(*network_).split(held_);
}

bool SpringBody::has_dashpots() const { return law_.kind == Viscosity::kelvin_voigt; }

SplitMatrix SpringBody::dashpots(const Vector& displacement) const {
  return dashpot_blocks(displacement).split(held_);
}

BlockMatrix SpringBody::dashpot_blocks(const Vector& displacement) const {
  // tau times the stiffness in the present directions; at rest D = tau K.
  std::fill(tension_.begin(), tension_.end(), 0.0);
  return tissue::tangent(*network_, kinematics_, displacement, law_.time, tension_);
}

void SpringBody::dashpot_force(const Vector& displacement, const Vector& velocity,
                               Vector& force) const {
  // tau times the forces of the elongations per second that the velocity gives.
  if (!dashpots_)
    dashpots_.emplace(*network_, tissue::Kinematics::linear, tissue::ViscousLaw{},
                      linear() ? tissue::Turning::never : tissue::Turning::sometimes);
  if (!linear() && (turned_at_.size() != displacement.size() || turned_at_ != displacement)) {
    if (!fast().stands_at(displacement)) {
      memory_at(displacement, memory_at_);
      fast().look(displacement, memory_at_);
    }
    dashpots_->turn_as(fast());
    turned_at_ = displacement;
  }
  dashpots_->look(velocity, {});
  dashpots_->force(force);
  force *= law_.time;
}

void SpringBody::memory_at(const Vector& displacement, std::vector<double>& memory) const {
  const std::size_t size = tissue::memory_size(law_);
  memory.assign(size * elongation_.size(), 0.0);
  if (size == 0) return;
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  for (std::size_t s = 0; s < elongation_.size(); ++s) {
    memory[size * s] = elongation_[s];
    if (law_.kind == Viscosity::kelvin_voigt) memory[size * s + 1] = elongation_[s];
  }
}

void SpringBody::remember(const Vector& displacement, const integrate::TimeStep& step,
                          std::vector<double>& memory) const {
  prepare(step);
  fast().remember(displacement, steps_, memory);
}

void SpringBody::step_force(const Vector& displacement, std::span<const double> memory,
                            const integrate::TimeStep& step, Vector& force) const {
  prepare(step);
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  tissue::effective_elongations(law_, steps_, memory, elongation_, effective_);
  tissue::tensions(*network_, effective_, tension_);
  tissue::gather_forces(*network_, kinematics_, displacement, tension_, force);
}

SplitMatrix SpringBody::step_stiffness(const Vector& displacement, std::span<const double> memory,
                                       const integrate::TimeStep& step) const {
  prepare(step);
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  tissue::effective_elongations(law_, steps_, memory, elongation_, effective_);
  tissue::tensions(*network_, effective_, tension_);
  return tissue::tangent(*network_, kinematics_, displacement,
                         tissue::effective_slope(law_, steps_), tension_)
      .split(held_);
}

void SpringBody::inherit(std::span<const double> other, std::size_t from, std::size_t to,
                         std::vector<double>& memory) const {
  const std::size_t size = tissue::memory_size(law_);
  for (std::size_t i = 1; i <= law_.branches.size(); ++i)
    memory[size * to + i] = other[size * from + i];
}

double SpringBody::stored(const integrate::State& state) const {
  if (const auto* energies = fast_ ? fast_->energies() : nullptr;
      energies != nullptr && fast_->knows(state.displacement, state.memory))
    return energies->stored;
  if (tissue::memory_size(law_) == 0) {
    tissue::elongations(*network_, kinematics_, state.displacement, elongation_);
    return tissue::stored_energy(*network_, law_, elongation_, scratch_);
  }
  return tissue::stored_energy(*network_, law_, state.memory, scratch_);
}

double SpringBody::kinetic(const integrate::State& state) const {
  return tissue::sum_of_squares(as_index(mass_.size()), mass_.data(), state.velocity.data());
}

double SpringBody::dissipated(const integrate::State& before, const integrate::State& after) const {
  const double time_step = after.time - before.time;
  if (time_step <= 0.0 || law_.kind == Viscosity::none) return 0.0;
  if (law_.kind == Viscosity::nodal_drag)  // d (du)^2 / dt
    return tissue::sum_of_moved_squares(as_index(drag_.size()), drag_.data(),
                                        before.displacement.data(), after.displacement.data()) /
           time_step;
  if (const auto* energies = fast_ ? fast_->energies() : nullptr;
      energies != nullptr && fast_->knows(after.displacement, after.memory) &&
      fast_->came_from(before.displacement))
    return law_.kind == Viscosity::kelvin_voigt ? law_.time * energies->lost / time_step
                                                : energies->lost;
  return tissue::dissipated_energy(*network_, law_, before.memory, after.memory, time_step,
                                   scratch_);
}

}  // namespace palpate::scene
