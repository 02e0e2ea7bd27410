// Springs in lanes give the bits of the plain loops, through steps, for every law and coupling.
#include "tissue/fast_springs.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <tuple>

#include "elastic_elongations.h"
#include "jittered_block.h"
#include "tissue/energy.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using test::Dice;
using tissue::FastSprings;
using tissue::Kinematics;
using tissue::Lanes;
using tissue::MemoryStep;
using tissue::Vector;
using tissue::Viscosity;
using tissue::ViscousLaw;

enum class Coupling { none, own_volume, nodal_volume, six, six_and_nodal };

geometry::TetMesh small_block() { return test::jittered_block({2, 3, 3}); }

tissue::Network network_of(const geometry::TetMesh& mesh, Coupling coupling) {
  const std::vector<tissue::Isotropic> tissues{{15e3, 0.45}};
  const bool six = coupling == Coupling::six || coupling == Coupling::six_and_nodal;
  if (six)
    return test::coupled_network(
        mesh, tissues,
        coupling == Coupling::six ? tissue::Volume::tetrahedron : tissue::Volume::nodal, 1.0);
  tissue::Network network = tissue::make_network(
      mesh, std::array{1000.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  if (coupling == Coupling::own_volume)
    tissue::add_volume(network, mesh, tissues, tissue::Volume::tetrahedron);
  if (coupling == Coupling::nodal_volume)
    tissue::add_volume(network, mesh, tissues, tissue::Volume::nodal);
  return network;
}

ViscousLaw law_of(Viscosity kind) {
  ViscousLaw law{.kind = kind, .time = 0.1, .drag = 30.0};
  if (kind == Viscosity::standard_linear_solid) law.branches = {{0.1, 0.5}};
  if (kind == Viscosity::prony) law.branches = {{0.1, 0.5}, {0.01, 1.5}, {1.0, 0.25}};
  return law;
}

std::vector<MemoryStep> steps_of(const ViscousLaw& law, double time_step) {
  std::vector<MemoryStep> steps;
  if (law.kind == Viscosity::kelvin_voigt) steps.push_back(MemoryStep::exact(time_step, law.time));
  for (const tissue::Branch& branch : law.branches)
    steps.push_back(MemoryStep::exact(time_step, branch.time));
  return steps;
}

// The readable loops.
struct Plain {
  const tissue::Network& network;
  Kinematics kinematics;
  ViscousLaw law;
  std::vector<double> elongation = std::vector<double>(network.ends.size());
  std::vector<double> effective = elongation;
  std::vector<double> tension = elongation;

  void remember(const Vector& u, std::span<const MemoryStep> steps, std::vector<double>& memory) {
    tissue::elongations(network, kinematics, u, elongation);
    tissue::remember(law, steps, elongation, memory);
  }
  Vector force(const Vector& u, std::span<const double> memory) {
    tissue::elongations(network, kinematics, u, elongation);
    test::elastic_elongations(law, memory, elongation, effective);
    tissue::tensions(network, effective, tension);
    Vector force;
    tissue::gather_forces(network, kinematics, u, tension, force);
    return force;
  }
};

template <class A, class B>
void expect_same_bits(const A& a, const B& b, const char* what) {
  ASSERT_EQ(static_cast<std::size_t>(a.size()), static_cast<std::size_t>(b.size()));
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.size()); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a.data()[i]), std::bit_cast<std::uint64_t>(b.data()[i]))
        << what << " " << i << ": " << a.data()[i] << " and " << b.data()[i];
}

Vector scattered(Eigen::Index size, double most, Dice& dice) {
  Vector u(size);
  for (double& component : u) component = 2.0 * most * (dice.roll() - 0.5);
  return u;
}

using Choice = std::tuple<Kinematics, Viscosity, Coupling, Lanes>;

class FastSpringsAre : public testing::TestWithParam<Choice> {};

TEST_P(FastSpringsAre, the_plain_loops_to_the_bit) {
  const auto& [kinematics, kind, coupling, lanes] = GetParam();
  const geometry::TetMesh mesh = small_block();
  const tissue::Network network = network_of(mesh, coupling);
  ASSERT_NE(network.ends.size() % 4, 0U);  // the last group is not full
  const ViscousLaw law = law_of(kind);
  Plain plain{network, kinematics, law};
  FastSprings fast(network, kinematics, law, tissue::Turning::sometimes, lanes);
  const auto steps = steps_of(law, 1e-3);
  std::vector<double> memory(tissue::memory_size(law) * network.ends.size(), 0.0);
  std::vector<double> fast_memory = memory;
  Dice dice(3);
  Vector u = Vector::Zero(3 * network.nodes());
  for (int step = 0; step < 4; ++step) {
    const std::vector<double> memory_before = memory;
    const Vector before = u;
    u = scattered(u.size(), 2e-4 * step, dice);
    plain.remember(u, steps, memory);
    fast.remember(u, steps, fast_memory);
    expect_same_bits(memory, fast_memory, "memory");
    Vector force;
    fast.force(force);
    expect_same_bits(plain.force(u, memory), force, "force");
    EXPECT_TRUE(fast.knows(u, memory));
    EXPECT_EQ(fast.came_from(before), step > 0);
    if (step == 0) continue;
    const FastSprings::Energies* energies = fast.energies();
    ASSERT_EQ(energies != nullptr, law.branches.empty() || coupling == Coupling::none);
    if (energies == nullptr) continue;
    const double stored =
        tissue::stored_energy(network, law, memory.empty() ? plain.elongation : memory);
    EXPECT_NEAR(energies->stored, stored, 1e-13 * stored);  // another order of some hundred terms
    if (kind == Viscosity::nodal_drag) continue;
    const double lost = tissue::dissipated_energy(network, law, memory_before, memory,
                                                  Vector::Zero(u.size()), 1e-3);
    const double factor = kind == Viscosity::kelvin_voigt ? law.time / 1e-3 : 1.0;
    EXPECT_NEAR(factor * energies->lost, lost, 1e-12 * std::abs(lost));  // and differences
  }
  // A look elsewhere leaves the memory.
  const Vector elsewhere = scattered(u.size(), 1e-3, dice);
  fast.look(elsewhere, fast_memory);
  expect_same_bits(memory, fast_memory, "memory");
  Vector force;
  fast.force(force);
  expect_same_bits(plain.force(elsewhere, memory), force, "force");
  EXPECT_EQ(fast.energies(), nullptr);
  EXPECT_FALSE(fast.knows(u, memory));
  if (law.branches.empty()) return;
  memory.back() += 1e-9;
  EXPECT_FALSE(fast.knows(elsewhere, memory));
}

// Dashpots by velocities: linear springs along directions that have turned.
TEST(FastSprings, TurnAsThePlainLoopsDo) {
  const geometry::TetMesh mesh = small_block();
  Dice dice(17);
  for (const Kinematics kinematics : {Kinematics::nonlinear, Kinematics::squared})
    for (const Lanes lanes : {Lanes::portable, Lanes::widest}) {
      tissue::Network network = network_of(mesh, Coupling::six_and_nodal);
      FastSprings standing(network, kinematics, {}, tissue::Turning::never, lanes);
      FastSprings turned(network, Kinematics::linear, {}, tissue::Turning::sometimes, lanes);
      for (int twice = 0; twice < 2; ++twice) {
        const Vector u = scattered(3 * network.nodes(), 1e-3, dice);
        const Vector v = scattered(u.size(), 1.0, dice);
        standing.look(u, {});
        turned.turn_as(standing);
        turned.look(v, {});
        Vector force;
        turned.force(force);
        tissue::directions(network, kinematics, u, network.direction);
        Plain plain{network, Kinematics::linear, {}};
        expect_same_bits(plain.force(v, std::vector<double>(network.ends.size())), force, "force");
      }
    }
}

std::string name_of(const testing::TestParamInfo<Choice>& one) {
  const auto& [kinematics, kind, coupling, lanes] = one.param;
  const char* const motions[] = {"linear", "nonlinear", "squared"};
  const char* const laws[] = {"none", "nodal_drag", "kelvin_voigt", "standard_linear_solid",
                              "prony"};
  const char* const couplings[] = {"independent", "own_volume", "nodal_volume", "six",
                                   "six_and_nodal"};
  const auto pick = [](const auto& names, auto value) {
    return std::string(names[static_cast<std::size_t>(value)]);
  };
  return pick(motions, kinematics) + "_" + pick(laws, kind) + "_" + pick(couplings, coupling) +
         (lanes == Lanes::portable ? "_portable" : "_widest");
}

INSTANTIATE_TEST_SUITE_P(
    every, FastSpringsAre,
    testing::Combine(
        testing::Values(Kinematics::linear, Kinematics::nonlinear, Kinematics::squared),
        testing::Values(Viscosity::none, Viscosity::nodal_drag, Viscosity::kelvin_voigt,
                        Viscosity::standard_linear_solid, Viscosity::prony),
        testing::Values(Coupling::none, Coupling::own_volume, Coupling::nodal_volume, Coupling::six,
                        Coupling::six_and_nodal),
        testing::Values(Lanes::portable, Lanes::widest)),
    name_of);

}  // namespace
}  // namespace palpate
