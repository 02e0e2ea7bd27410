// Spring loops behind the integrators' interface.
#include "scene/spring_body.h"

#include <cstring>
#include <utility>

#include "tissue/energy.h"

namespace palpate::scene {
namespace {

using tissue::Memory;
using tissue::Viscosity;

// The integrators' plain numbers, two a spring, as the springs' memory.
Memory memory_of(std::span<const double> memory, std::size_t spring) {
  return {memory[2 * spring], memory[2 * spring + 1]};
}

std::vector<Memory> memories(std::span<const double> memory) {
  std::vector<Memory> all(memory.size() / 2);
  for (std::size_t s = 0; s < all.size(); ++s) all[s] = memory_of(memory, s);
  return all;
}

}  // namespace

SpringBody::SpringBody(const tissue::Network& network, tissue::Kinematics kinematics,
                       const tissue::ViscousLaw& law, std::vector<char> held)
    : network_(&network),
      kinematics_(kinematics),
      law_(law),
      held_(std::move(held)),
      elongation_(network.stiffness.size()),
      tension_(network.stiffness.size()),
      slope_(network.stiffness.size()) {
  mass_ = spread_mass(1.0);
  drag_ = spread_mass(law.kind == Viscosity::nodal_drag ? law.drag : 0.0);
  if (law.kind == Viscosity::nodal_drag) proportional_.drag_rate = law.drag;
  if (law.kind == Viscosity::kelvin_voigt) proportional_.retardation_time = law.time;
  if (law.kind == Viscosity::standard_linear_solid) {
    proportional_.relaxation_time = law.time;
    proportional_.branch = law.branch;
  }
}

integrate::Vector SpringBody::spread_mass(double factor) const {
  Vector vector(3 * network_->nodes());
  for (Eigen::Index d = 0; d < vector.size(); ++d)
    vector[d] = factor * network_->node_mass[static_cast<std::size_t>(d / 3)];
  return vector;
}

tissue::MemoryStep SpringBody::memory_step(const integrate::TimeStep& step) const {
  if (law_.time <= 0.0 || step.size <= 0.0) return tissue::MemoryStep::at_once();
  switch (step.rule) {
    case integrate::MemoryRule::exact: return tissue::MemoryStep::exact(step.size, law_.time);
    case integrate::MemoryRule::held: return tissue::MemoryStep::held(step.size, law_.time);
    case integrate::MemoryRule::first_order:
      return tissue::MemoryStep::first_order(step.size, law_.time);
    case integrate::MemoryRule::at_once: break;
  }
  return tissue::MemoryStep::at_once();
}

void SpringBody::force(const Vector& displacement, std::span<const double> memory,
                       Vector& force) const {
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  const bool branch = law_.kind == Viscosity::standard_linear_solid;
  for (std::size_t s = 0; s < tension_.size(); ++s) {
    double stretch = elongation_[s];
    if (branch) stretch += law_.branch * (elongation_[s] - memory[2 * s + 1]);
    tension_[s] = network_->stiffness[s] * stretch;
  }
  tissue::gather_forces(*network_, kinematics_, displacement, tension_, force);
}

integrate::SparseMatrix SpringBody::stiffness() const {
  const std::vector<double> zero(network_->stiffness.size(), 0.0);
  return tissue::tangent(*network_, tissue::Kinematics::linear, Vector::Zero(mass_.size()),
                         network_->stiffness, zero, held_);
}

bool SpringBody::has_dashpots() const { return law_.kind == Viscosity::kelvin_voigt; }

integrate::SparseMatrix SpringBody::dashpots(const Vector& displacement) const {
  // c = tau k along every spring, as it stands: at rest D = tau K
  std::vector<double> damping = network_->stiffness;
  for (double& c : damping) c *= law_.time;
  const std::vector<double> zero(damping.size(), 0.0);
  return tissue::tangent(*network_, kinematics_, displacement, damping, zero, held_);
}

void SpringBody::dashpot_force(const Vector& displacement, const Vector& velocity,
                               Vector& force) const {
  tissue::elongation_rates(*network_, kinematics_, displacement, velocity, tension_);
  for (std::size_t s = 0; s < tension_.size(); ++s)
    tension_[s] *= law_.time * network_->stiffness[s];
  tissue::gather_forces(*network_, kinematics_, displacement, tension_, force);
}

std::vector<double> SpringBody::memory_at(const Vector& displacement) const {
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  std::vector<double> memory(2 * elongation_.size());
  for (std::size_t s = 0; s < elongation_.size(); ++s) {
    memory[2 * s] = elongation_[s];
    memory[2 * s + 1] = law_.kind == Viscosity::kelvin_voigt ? elongation_[s] : 0.0;
  }
  return memory;
}

void SpringBody::remember(const Vector& displacement, const integrate::TimeStep& step,
                          std::vector<double>& memory) const {
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  const tissue::MemoryStep through = memory_step(step);
  for (std::size_t s = 0; s < elongation_.size(); ++s) {
    const Memory next = tissue::remembered(law_, memory_of(memory, s), through, elongation_[s]);
    memory[2 * s] = next.elongation;
    memory[2 * s + 1] = next.internal;
  }
}

void SpringBody::step_force(const Vector& displacement, std::span<const double> memory,
                            const integrate::TimeStep& step, Vector& force) const {
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  const tissue::MemoryStep through = memory_step(step);
  for (std::size_t s = 0; s < tension_.size(); ++s)
    tension_[s] = network_->stiffness[s] *
                  tissue::step_tension(law_, memory_of(memory, s), through, elongation_[s]).value;
  tissue::gather_forces(*network_, kinematics_, displacement, tension_, force);
}

integrate::SparseMatrix SpringBody::step_stiffness(const Vector& displacement,
                                                   std::span<const double> memory,
                                                   const integrate::TimeStep& step) const {
  tissue::elongations(*network_, kinematics_, displacement, elongation_);
  const tissue::MemoryStep through = memory_step(step);
  for (std::size_t s = 0; s < tension_.size(); ++s) {
    const auto tension = tissue::step_tension(law_, memory_of(memory, s), through, elongation_[s]);
    tension_[s] = network_->stiffness[s] * tension.value;
    slope_[s] = network_->stiffness[s] * tension.slope;
  }
  return tissue::tangent(*network_, kinematics_, displacement, slope_, tension_, held_);
}

void SpringBody::inherit(std::span<const double> other, std::size_t from, std::size_t to,
                         std::vector<double>& memory) const {
  if (law_.kind == Viscosity::standard_linear_solid) memory[2 * to + 1] = other[2 * from + 1];
}

double SpringBody::stored(const integrate::State& state) const {
  return tissue::stored_energy(*network_, law_, memories(state.memory));
}

double SpringBody::kinetic(const integrate::State& state) const {
  double sum = 0.0;
  for (Eigen::Index d = 0; d < mass_.size(); ++d)
    sum += 0.5 * mass_[d] * state.velocity[d] * state.velocity[d];
  return sum;
}

double SpringBody::dissipated(const integrate::State& before, const integrate::State& after) const {
  const double time_step = after.time - before.time;
  if (time_step <= 0.0) return 0.0;
  return tissue::dissipated_energy(*network_, law_, memories(before.memory), memories(after.memory),
                                   after.displacement - before.displacement, time_step);
}

}  // namespace palpate::scene
