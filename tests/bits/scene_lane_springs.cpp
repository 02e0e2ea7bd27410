// Bodies that step lane beside lane give the bits of each alone, whatever their neighbours do.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <tuple>

#include "integrate/central_difference.h"
#include "jittered_block.h"
#include "scene/spring_body.h"
#include "tissue/fast_vectors.h"
#include "tissue/lane_springs.h"
#include "tissue/stable_step.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Lanes;
using tissue::LaneSprings;
using tissue::SparseLoad;
using tissue::Vector;
using tissue::Viscosity;

enum class Coupling { none, six_and_nodal };

std::vector<std::uint64_t> bits(const Vector& vector) {
  std::vector<std::uint64_t> all;
  for (const double value : vector) all.push_back(std::bit_cast<std::uint64_t>(value));
  return all;
}

// One of several bodies on a mesh: no two have the same tissue, law, supports or step.
struct Alone {
  tissue::Network network;
  tissue::ViscousLaw law;
  std::vector<char> held;
  double time_step = 0.0;
  integrate::Start start = integrate::Start::consistent;
  integrate::State state;
  SparseLoad before, after;
  std::optional<scene::SpringBody> body;
  std::optional<integrate::CentralDifference> method;
  tissue::LaneEnergies energies;

  Alone(const geometry::TetMesh& mesh, Coupling coupling, Viscosity kind, int number) {
    const double modulus = 15e3 * (1.0 + 0.3 * number);
    network = tissue::make_network(mesh, std::array{1000.0 + 50.0 * number},
                                   tissue::fitted_stiffness(mesh, std::array{modulus}));
    if (coupling == Coupling::six_and_nodal)
      tissue::couple(network, mesh, std::vector<tissue::Isotropic>{{modulus, 0.3 + 0.03 * number}},
                     tissue::Volume::nodal, 1.0);
    law = {.kind = kind, .drag = kind == Viscosity::nodal_drag ? 20.0 + number : 0.0};
    if (kind == Viscosity::standard_linear_solid) law.branches = {{0.01 + 0.01 * number, 0.5}};
    if (kind == Viscosity::prony) law.branches = {{0.1, 0.2 * number}, {0.01, 1.5}};
    held.assign(3 * mesh.nodes.size(), 0);
    for (std::size_t d = 0; d < held.size(); ++d)
      held[d] = mesh.nodes[d / 3].z() < 1e-9 && (number % 2 == 0 || d % 3 == 2) ? 1 : 0;
    // Number 3 leaves the finite numbers within the test.
    const double squared =
        law.instantaneous_ratio() * tissue::largest_frequency_squared(network, held);
    time_step = (number == 3 ? 1e4 : 0.8) / std::sqrt(squared);
    if (number == 4) start = integrate::Start::paper;
    body.emplace(network, tissue::Kinematics::linear, law, held);
    state.displacement = Vector::Zero(3 * network.nodes());
    test::Dice dice(static_cast<std::uint64_t>(number));
    for (Eigen::Index d = 0; d < state.displacement.size(); ++d)
      if (held[static_cast<std::size_t>(d)] == 0)
        state.displacement[d] = 1e-4 * (dice.roll() - 0.5);
    state.velocity = 3.0 * state.displacement;
    state.memory = body->memory_at(state.displacement);
    begin();
  }

  void begin() { method.emplace(*body, time_step, start); }

  // A load that moves over a few nodes.
  [[nodiscard]] SparseLoad load_at(int step) const {
    SparseLoad load;
    for (int k = 0; k < 3; ++k) {
      load.freedoms.push_back(3 * (network.nodes() - 1 - (step + 2 * k) % 7) + k);
      load.forces.push_back(-0.01 * (k + 1) * (1 + step % 3));
    }
    std::sort(load.freedoms.begin(), load.freedoms.end());
    return load;
  }

  void step() {
    const auto full = [&](const SparseLoad& few) {
      Vector load = Vector::Zero(state.displacement.size());
      for (std::size_t k = 0; k < few.freedoms.size(); ++k) load[few.freedoms[k]] = few.forces[k];
      return load;
    };
    const integrate::State old = state;
    const Vector load_before = full(before);
    const Vector load_after = full(after);
    method->step(state, load_before);
    energies.work = tissue::work_of_forces(static_cast<std::size_t>(load_after.size()),
                                           load_before.data(), load_after.data(),
                                           old.displacement.data(), state.displacement.data());
    energies.kinetic = body->kinetic(state);
    energies.stored = body->stored(state);
    energies.lost = body->dissipated(old, state);
    if (law.kind == Viscosity::nodal_drag) energies.lost *= state.time - old.time;
  }

  void enter(LaneSprings& lanes, std::size_t lane) const {
    lanes.enter(lane, network, law, held);
    Vector force;
    body->force(state.displacement, state.memory, force);
    lanes.place(lane, {&state.displacement, &state.velocity, &force, state.memory});
    begin(lanes, lane);
  }
  void begin(LaneSprings& lanes, std::size_t lane) const {
    lanes.begin(lane, {time_step, start == integrate::Start::consistent});
  }
};

using Choice = std::tuple<Viscosity, Coupling, Lanes>;

class LanesOfBodies : public testing::TestWithParam<Choice> {};

// Five lanes of eight; one enters late, one begins anew on the way with another step, one diverges
// and one leaves.
TEST_P(LanesOfBodies, step_as_each_body_alone) {
  const auto& [kind, coupling, lanes_kind] = GetParam();
  const geometry::TetMesh mesh = test::jittered_block({2, 3, 3});
  std::vector<Alone> bodies;
  bodies.reserve(5);
  for (int number = 0; number < 5; ++number) bodies.emplace_back(mesh, coupling, kind, number);
  // Branches of coupled springs step alone.
  const bool alone = coupling != Coupling::none && !bodies[0].law.branches.empty();
  ASSERT_EQ(LaneSprings::can(bodies[0].network, bodies[0].law), !alone);
  if (alone) return;
  LaneSprings lanes(bodies[0].network, bodies[0].law, lanes_kind);
  const auto lane_of = [](std::size_t i) { return (3 * i + 1) % LaneSprings::width; };
  bool diverged = false;
  for (int step = 0; step < 60; ++step) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      Alone& one = bodies[i];
      const bool here = (i != 1 || step >= 10) && (i != 2 || step < 40);
      if (i == 2 && step == 40) lanes.leave(lane_of(i));
      if (!here) continue;
      if (step == (i == 1 ? 10 : 0)) one.enter(lanes, lane_of(i));
      if (i == 0 && step == 25) {
        one.time_step *= 0.7;
        one.begin();
        one.begin(lanes, lane_of(i));
      }
      one.before = one.load_at(step);
      one.after = one.load_at(step + 1);
      lanes.load(lane_of(i), one.before, one.after);
    }
    lanes.step();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if ((i == 1 && step < 10) || (i == 2 && step >= 40)) continue;
      Alone& one = bodies[i];
      one.step();
      Vector displacement, force, force_alone;
      lanes.displacement(lane_of(i), displacement);
      const tissue::LaneEnergies& energies = lanes.energies(lane_of(i));
      if (!std::isfinite(one.energies.kinetic + one.energies.stored)) {
        EXPECT_EQ(i, 3U);
        EXPECT_FALSE(std::isfinite(energies.kinetic + energies.stored));
        diverged = true;
        continue;
      }
      ASSERT_EQ(bits(displacement), bits(one.state.displacement)) << i << " at " << step;
      lanes.force(lane_of(i), force);
      one.body->force(one.state.displacement, one.state.memory, force_alone);
      ASSERT_EQ(bits(force), bits(force_alone)) << i << " at " << step;
      EXPECT_EQ(energies.work, one.energies.work);
      EXPECT_EQ(energies.kinetic, one.energies.kinetic);
      EXPECT_EQ(energies.stored, one.energies.stored);
      if (kind != Viscosity::nodal_drag) {
        EXPECT_EQ(energies.lost, one.energies.lost);
      } else {  // a quotient and a product of the time step
        EXPECT_NEAR(energies.lost, one.energies.lost, 1e-12 * one.energies.lost);
      }
    }
  }
  EXPECT_TRUE(diverged);
}

INSTANTIATE_TEST_SUITE_P(AllForms, LanesOfBodies,
                         testing::Combine(testing::Values(Viscosity::none, Viscosity::nodal_drag,
                                                          Viscosity::standard_linear_solid,
                                                          Viscosity::prony),
                                          testing::Values(Coupling::none, Coupling::six_and_nodal),
                                          testing::Values(Lanes::portable, Lanes::widest)));

}  // namespace
}  // namespace palpate
