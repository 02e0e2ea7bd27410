// Implements the integrators' body with one matrix, or with the loop over springs that turn.
#include "scene/spring_body.h"

#include <algorithm>
#include <utility>

#include "integrate/wide_loops.h"

namespace palpate::scene {

using integrate::State;
namespace wide = integrate::wide;
using tissue::MemoryStep;
using tissue::Viscosity;

namespace {

using Numbers = Eigen::Map<const Eigen::VectorXd>;

// Array `which` of a memory of arrays of `count` numbers.
Numbers part_of(std::span<const double> memory, Eigen::Index count, std::size_t which) {
  return Numbers(memory.data() + as_index(count) * which, count);
}

std::span<double> numbers(Eigen::VectorXd& vector) {
  return {vector.data(), as_index(vector.size())};
}
std::span<const double> numbers(const Eigen::VectorXd& vector) {
  return {vector.data(), as_index(vector.size())};
}

double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return wide::product(as_index(a.size()), a.data(), b.data());
}

}  // namespace

SpringBody::SpringBody(const tissue::Network& network, tissue::Kinematics kinematics,
                       const tissue::ViscousLaw& law, std::vector<char> held)
    : network_(&network), kinematics_(kinematics), law_(law), held_(std::move(held)) {
  mass_ = spread_mass(1.0);
  steps_.reserve(1 + law.branches.size());
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

tissue::SpringLoop& SpringBody::loop() const {
  if (!loop_) loop_.emplace(*network_, kinematics_);
  return *loop_;
}

const BlockMatrix& SpringBody::stiffness() const {
  if (!stiffness_) stiffness_.emplace(tissue::stiffness_matrix(*network_));
  return *stiffness_;
}

// What the law remembers: the displacement itself or, where springs turn, their elongations.
const integrate::Vector& SpringBody::measure(const Vector& displacement) const {
  if (linear()) return displacement;
  elongation_.resize(network_->springs());
  loop().elongations(displacement, numbers(elongation_));
  return elongation_;
}

// The elastic forces or tensions of what measure() returns.
void SpringBody::respond(const Vector& measured, Vector& response) const {
  if (linear()) return stiffness().multiply(measured, response);
  response.resize(measured.size());
  tissue::tensions(*network_, numbers(measured), numbers(response));
}

void SpringBody::look(State& state) const {
  const bool coupled = !network_->coupled.empty() || !network_->volumes.empty();
  const std::size_t remembered = tissue::memory_size(law_);
  if (!linear() && !coupled && remembered == 0) {
    state.stored = loop().elastic(state.displacement, state.force);
    return;
  }
  const Vector& measured = measure(state.displacement);
  Vector& sum = linear() ? state.force : tension_;
  respond(measured, sum);
  state.stored = 0.5 * product(measured, sum);
  state.parts.resize(remembered == 0 ? 0 : remembered - 1);
  if (law_.kind == Viscosity::kelvin_voigt) state.parts[0] = sum;
  for (std::size_t k = 0; k < law_.branches.size(); ++k) {
    Vector& part = state.parts[k];
    difference_ = measured - part_of(state.memory, measured.size(), 1 + k);
    respond(difference_, part);
    part *= law_.branches[k].ratio;
    state.stored += 0.5 * product(difference_, part);
    sum += part;
  }
  if (!linear()) loop().pull(state.displacement, numbers(sum), state.force);
}

bool SpringBody::has_dashpots() const { return law_.kind == Viscosity::kelvin_voigt; }

// tau times the stiffness in the present directions; at rest D = tau K.
BlockMatrix SpringBody::dashpots(const Vector& displacement) const {
  const std::vector<double> none(network_->ends.size(), 0.0);
  return tissue::tangent(*network_, kinematics_, displacement, law_.time, none);
}

// tau times the forces of the elongations per second that the velocity gives.
void SpringBody::dashpot_force(const Vector& displacement, const Vector& velocity,
                               Vector& force) const {
  if (linear()) {
    stiffness().multiply(velocity, force);
  } else {
    elongation_.resize(network_->springs());
    loop().rates(displacement, velocity, numbers(elongation_));
    respond(elongation_, tension_);
    loop().pull(displacement, numbers(tension_), force);
  }
  force *= law_.time;
}

void SpringBody::memory_at(const Vector& displacement, std::vector<double>& memory) const {
  memory.clear();
  const std::size_t size = tissue::memory_size(law_);
  if (size == 0) return;
  const Vector& measured = measure(displacement);
  memory.assign(size * as_index(measured.size()), 0.0);
  std::ranges::copy(measured, memory.begin());
  if (law_.kind == Viscosity::kelvin_voigt)
    std::ranges::copy(measured, memory.begin() + measured.size());
}

void SpringBody::remember(const Vector& displacement, const integrate::TimeStep& step,
                          std::vector<double>& memory) const {
  if (tissue::memory_size(law_) == 0) return;
  prepare(step);
  tissue::remember(law_, steps_, numbers(measure(displacement)), memory);
}

void SpringBody::step_force(const Vector& displacement, std::span<const double> memory,
                            const integrate::TimeStep& step, Vector& force) const {
  prepare(step);
  const Vector& measured = measure(displacement);
  difference_.resize(measured.size());
  tissue::effective_elongations(law_, steps_, memory, numbers(measured), numbers(difference_));
  respond(difference_, linear() ? force : tension_);
  if (!linear()) loop().pull(displacement, numbers(tension_), force);
}

SplitMatrix SpringBody::step_stiffness(const Vector& displacement, std::span<const double> memory,
                                       const integrate::TimeStep& step) const {
  prepare(step);
  BlockMatrix matrix;
  if (linear()) {
    matrix = stiffness();
    matrix *= tissue::effective_slope(law_, steps_);
  } else {
    const Vector& measured = measure(displacement);
    difference_.resize(measured.size());
    tissue::effective_elongations(law_, steps_, memory, numbers(measured), numbers(difference_));
    respond(difference_, tension_);
    matrix = tissue::tangent(*network_, kinematics_, displacement,
                             tissue::effective_slope(law_, steps_), numbers(tension_));
  }
  return matrix.split(held_);
}

void SpringBody::inherit(std::span<const double> other, std::size_t count, std::size_t from,
                         std::size_t to, std::vector<double>& memory) const {
  const std::size_t own = memory.size() / std::max<std::size_t>(1, tissue::memory_size(law_));
  for (std::size_t i = 1; i <= law_.branches.size(); ++i)
    memory[own * i + to] = other[count * i + from];
}

double SpringBody::stored(const State& state) const {
  if (state.force.size() > 0) return state.stored;
  State looked = state;
  look(looked);
  return looked.stored;
}

double SpringBody::kinetic(const State& state) const {
  return wide::kinetic(as_index(mass_.size()), mass_.data(), state.velocity.data());
}

double SpringBody::dissipated(const State& before, const State& after) const {
  const double time_step = after.time - before.time;
  if (time_step <= 0.0 || law_.kind == Viscosity::none) return 0.0;
  if (law_.kind == Viscosity::nodal_drag)  // d (du)^2 / dt
    return wide::moved_squares(as_index(drag_.size()), drag_.data(), before.displacement.data(),
                               after.displacement.data()) /
           time_step;
  if (before.force.size() == 0) {
    State looked = before;
    look(looked);
    return dissipated(looked, after);
  }
  const auto count = static_cast<Eigen::Index>(after.memory.size() / tissue::memory_size(law_));
  const auto work = [&](std::size_t which, const Vector& part_before, const Vector& part_after) {
    return wide::work(as_index(count), part_before.data(), part_after.data(),
                      part_of(before.memory, count, which).data(),
                      part_of(after.memory, count, which).data());
  };
  if (law_.kind == Viscosity::kelvin_voigt) {  // tau de.E de / dt
    difference_ = -before.parts[0];
    return 2.0 * law_.time * work(0, difference_, after.parts[0]) / time_step;
  }
  double sum = 0.0;  // b (e - q).E dq of every branch, with the mean of e - q
  for (std::size_t k = 0; k < law_.branches.size(); ++k)
    sum += work(1 + k, before.parts[k], after.parts[k]);
  return sum;
}

}  // namespace palpate::scene
