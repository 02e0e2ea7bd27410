// The force of a body by one matrix is that of its springs with a memory of their own, for every
// law and coupling, through steps; so are its energies.
#include "plain_springs.h"
#include "scene/spring_body.h"

#include <gtest/gtest.h>

#include <tuple>

#include "elastic_elongations.h"
#include "jittered_block.h"
#include "plain_energy.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using test::Dice;
using tissue::Kinematics;
using tissue::MemoryStep;
using tissue::Vector;
using tissue::Viscosity;
using tissue::ViscousLaw;

enum class Coupled { none, own_volume, nodal_volume, six, six_and_nodal };

geometry::TetMesh small_block() { return test::jittered_block({2, 3, 3}); }

tissue::Network network_of(const geometry::TetMesh& mesh, Coupled coupling) {
  const std::vector<tissue::Isotropic> tissues{{15e3, 0.45}};
  const bool six = coupling == Coupled::six || coupling == Coupled::six_and_nodal;
  if (six)
    return test::coupled_network(
        mesh, tissues,
        coupling == Coupled::six ? tissue::Volume::tetrahedron : tissue::Volume::nodal, 1.0);
  tissue::Network network = tissue::make_network(
      mesh, std::array{1000.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  if (coupling == Coupled::own_volume)
    tissue::add_volume(network, mesh, tissues, tissue::Volume::tetrahedron);
  if (coupling == Coupled::nodal_volume)
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
    test::elongations(network, kinematics, u, elongation);
    tissue::remember(law, steps, elongation, memory);
  }
  Vector force(const Vector& u, std::span<const double> memory) {
    test::elongations(network, kinematics, u, elongation);
    test::elastic_elongations(law, memory, elongation, effective);
    tissue::tensions(network, effective, tension);
    Vector force;
    test::gather_forces(network, kinematics, u, tension, force);
    return force;
  }
};

using LawOf = std::tuple<Kinematics, Viscosity, Coupled>;

class SpringBodyIs : public testing::TestWithParam<LawOf> {};

TEST_P(SpringBodyIs, its_springs_one_by_one) {
  const auto& [kinematics, kind, coupling] = GetParam();
  const geometry::TetMesh mesh = small_block();
  const tissue::Network network = network_of(mesh, coupling);
  const ViscousLaw law = law_of(kind);
  constexpr double time_step = 1e-3;  // s
  Plain plain{network, kinematics, law};
  const auto steps = steps_of(law, time_step);
  std::vector<double> memory(tissue::memory_size(law) * network.ends.size(), 0.0);
  const scene::SpringBody body(network, kinematics, law, test::nothing_held(network));
  integrate::State state;
  state.displacement = state.velocity = Vector::Zero(3 * network.nodes());
  state.memory = body.memory_at(state.displacement);
  body.look(state);
  Dice dice(3);
  for (int step = 1; step < 5; ++step) {
    const integrate::State before = state;
    const std::vector<double> memory_before = memory;
    for (double& component : state.displacement) component = 4e-4 * step * (dice.roll() - 0.5);
    state.time += time_step;
    body.arrive(state, {time_step, integrate::MemoryRule::exact});
    plain.remember(state.displacement, steps, memory);
    const Vector want = plain.force(state.displacement, memory);
    EXPECT_LE((state.force - want).cwiseAbs().maxCoeff(), 1e-12 * want.cwiseAbs().maxCoeff());
    const double stored =
        test::stored_energy(network, law, memory.empty() ? plain.elongation : memory);
    EXPECT_NEAR(body.stored(state), stored, 1e-11 * stored);
    const double lost = test::dissipated_energy(
        network, law, memory_before, memory, state.displacement - before.displacement, time_step);
    // A difference of energies that are larger by the ratio of the times.
    EXPECT_NEAR(body.dissipated(before, state), lost, 1e-11 * (stored + std::abs(lost)));
  }
}

std::string name_of(const testing::TestParamInfo<LawOf>& one) {
  const auto& [kinematics, kind, coupling] = one.param;
  const char* const motions[] = {"linear", "nonlinear", "squared"};
  const char* const laws[] = {"none", "nodal_drag", "kelvin_voigt", "standard_linear_solid",
                              "prony"};
  const char* const couplings[] = {"independent", "own_volume", "nodal_volume", "six",
                                   "six_and_nodal"};
  const auto pick = [](const auto& names, auto value) {
    return std::string(names[static_cast<std::size_t>(value)]);
  };
  return pick(motions, kinematics) + "_" + pick(laws, kind) + "_" + pick(couplings, coupling);
}

INSTANTIATE_TEST_SUITE_P(
    every, SpringBodyIs,
    testing::Combine(
        testing::Values(Kinematics::linear, Kinematics::nonlinear, Kinematics::squared),
        testing::Values(Viscosity::none, Viscosity::nodal_drag, Viscosity::kelvin_voigt,
                        Viscosity::standard_linear_solid, Viscosity::prony),
        testing::Values(Coupled::none, Coupled::own_volume, Coupled::nodal_volume, Coupled::six,
                        Coupled::six_and_nodal)),
    name_of);

}  // namespace
}  // namespace palpate
