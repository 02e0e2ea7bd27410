// A step of central differences on springs is what its equations say, dashpots turned or not.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "integrate/central_difference.h"
#include "jittered_block.h"
#include "scene/spring_body.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Kinematics;
using tissue::Vector;
using tissue::Viscosity;

constexpr double time_step = 2e-4;  // s

enum class Coupling { none, six_and_nodal };

struct Block {
  geometry::TetMesh mesh = test::jittered_block({2, 2, 3});
  tissue::Network network;
  std::vector<char> held;

  explicit Block(Coupling coupling) {
    network = tissue::make_network(mesh, std::array{1000.0},
                                   tissue::van_gelder_stiffness(mesh, std::array{15e3}));
    if (coupling == Coupling::six_and_nodal)
      tissue::couple(network, mesh, std::vector<tissue::Isotropic>{{15e3, 0.45}},
                     tissue::Volume::nodal, 1.0);
    held.assign(3 * mesh.nodes.size(), 0);
    for (std::size_t d = 0; d < held.size(); ++d) held[d] = mesh.nodes[d / 3].z() < 1e-9 ? 1 : 0;
  }
};

using Choice = std::tuple<Kinematics, Coupling>;

class KelvinVoigtStep : public testing::TestWithParam<Choice> {};

// (2 M + D dt) w_1 = 2 dt^2 (F - f(u)) + (2 M - D dt) w_0, by dense algebra.
TEST_P(KelvinVoigtStep, solves_the_equation_with_dashpots_as_they_stand) {
  const auto& [kinematics, coupling] = GetParam();
  const Block block(coupling);
  const tissue::ViscousLaw law{.kind = Viscosity::kelvin_voigt, .time = 0.1};
  const scene::SpringBody body(block.network, kinematics, law, block.held);
  const scene::SpringBody other(block.network, kinematics, law, block.held);
  integrate::State state;
  state.displacement = Vector::Zero(3 * block.network.nodes());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  Vector load = Vector::Zero(state.displacement.size());
  for (Eigen::Index d = 0; d < load.size(); ++d)
    if (block.held[static_cast<std::size_t>(d)] == 0) load[d] = d % 3 == 1 ? 0.02 : -0.01;
  integrate::CentralDifference method(body, time_step, integrate::Start::consistent);
  for (int step = 0; step < 80; ++step) {
    const Vector before = state.displacement;
    const Vector moved_before = time_step * state.velocity;
    Vector force;
    other.force(before, other.memory_at(before), force);
    const Eigen::MatrixXd damping = test::dense(other.dashpots(before));
    method.step(state, load);
    Eigen::MatrixXd left = time_step * damping;
    left.diagonal() += 2.0 * body.mass();
    const bool first = step == 0;
    Vector right = (first ? 1.0 : 2.0) * time_step * time_step * (load - force) +
                   2.0 * body.mass().cwiseProduct(moved_before);
    if (!first) right -= time_step * damping * moved_before;
    for (std::size_t d = 0; d < block.held.size(); ++d)
      if (block.held[d] != 0) right[static_cast<Eigen::Index>(d)] = 0.0;
    const Vector want = left.ldlt().solve(right);
    // Where dashpots turn, the tolerance of the conjugate gradients, in another norm; else rounding
    // at a condition of about 1e4.
    const double tolerance = kinematics == Kinematics::linear ? 1e-11 : 1e-8;
    EXPECT_LE((time_step * state.velocity - want).norm(), tolerance * want.norm()) << step;
  }
  // The block has turned: its dashpots are no longer those at rest.
  EXPECT_GT(state.displacement.cwiseAbs().maxCoeff(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(every, KelvinVoigtStep,
                         testing::Values(Choice{Kinematics::linear, Coupling::none},
                                         Choice{Kinematics::nonlinear, Coupling::none},
                                         Choice{Kinematics::linear, Coupling::six_and_nodal},
                                         Choice{Kinematics::squared, Coupling::six_and_nodal}));

// What the body keeps from its last call never stands in for what was not asked.
TEST(SpringBody, ForcesFollowWhatTheyAreAskedFor) {
  const Block block(Coupling::none);
  tissue::ViscousLaw law{.kind = Viscosity::standard_linear_solid, .branches = {{0.1, 0.5}}};
  const scene::SpringBody body(block.network, Kinematics::nonlinear, law, block.held);
  const Vector u = test::scattered_displacement(block.mesh, 2e-4);
  std::vector<double> memory = body.memory_at(Vector::Zero(u.size()));
  const auto fresh = [&](const Vector& at) {
    const scene::SpringBody another(block.network, Kinematics::nonlinear, law, block.held);
    Vector force;
    another.force(at, memory, force);
    return force;
  };
  Vector force;
  body.force(u, memory, force);
  EXPECT_EQ(force, fresh(u));
  body.remember(u, {time_step, integrate::MemoryRule::exact}, memory);
  body.force(u, memory, force);
  EXPECT_EQ(force, fresh(u));
  memory[3] += 1e-6;  // the branch of one spring
  body.force(u, memory, force);
  EXPECT_EQ(force, fresh(u));
  Vector elsewhere = u;
  elsewhere[10] += 1e-6;
  body.force(elsewhere, memory, force);
  EXPECT_EQ(force, fresh(elsewhere));
}

// Energies at hand are those of the plain sums, and only of the states they belong to.
TEST(SpringBody, EnergiesBelongToTheirStates) {
  const Block block(Coupling::six_and_nodal);
  const tissue::ViscousLaw law{.kind = Viscosity::kelvin_voigt, .time = 0.1};
  const scene::SpringBody body(block.network, Kinematics::linear, law, block.held);
  integrate::State before;
  before.displacement = test::scattered_displacement(block.mesh, 1e-4);
  before.velocity = before.displacement;
  before.memory = body.memory_at(before.displacement);
  body.remember(before.displacement, {time_step, integrate::MemoryRule::exact}, before.memory);
  integrate::State after = before;
  after.time = time_step;
  after.displacement *= 1.25;
  body.remember(after.displacement, {time_step, integrate::MemoryRule::exact}, after.memory);
  const scene::SpringBody unaware(block.network, Kinematics::linear, law, block.held);
  const auto close = [](double a, double b) { EXPECT_NEAR(a, b, 1e-11 * std::abs(b)); };
  close(body.stored(after), unaware.stored(after));  // sums in another order
  close(body.dissipated(before, after), unaware.dissipated(before, after));
  close(body.stored(before), unaware.stored(before));
  integrate::State elsewhere = before;
  elsewhere.displacement *= 0.5;
  elsewhere.memory = body.memory_at(elsewhere.displacement);
  close(body.dissipated(elsewhere, after), unaware.dissipated(elsewhere, after));
}

}  // namespace
}  // namespace palpate
