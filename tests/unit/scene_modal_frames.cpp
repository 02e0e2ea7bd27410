// Frames in modes alone are the steps that the body is shown at, and keep its account of energy.
#include <gtest/gtest.h>

#include "integrate/modal.h"
#include "jittered_block.h"
#include "scene/spring_body.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Vector;
using tissue::Viscosity;

constexpr double time_step = 1e-3;  // s

class ModalFrames : public testing::TestWithParam<Viscosity> {};

TEST_P(ModalFrames, are_the_steps_and_their_energies) {
  const geometry::TetMesh mesh = test::jittered_block({2, 2, 2});
  const tissue::Network network = tissue::make_network(
      mesh, std::array{1000.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < held.size(); ++d) held[d] = mesh.nodes[d / 3].z() < 1e-9 ? 1 : 0;
  const tissue::ViscousLaw law{.kind = GetParam(), .time = 0.01, .drag = 30.0};
  const scene::SpringBody body(network, tissue::Kinematics::linear, law, held);
  integrate::State state;
  state.displacement = state.velocity = Vector::Zero(3 * network.nodes());
  state.memory = body.memory_at(state.displacement);
  const integrate::State rest = state;
  integrate::Modal shown(body);
  integrate::Modal alone(body);
  ASSERT_TRUE(alone.passes_alone());

  Vector load = Vector::Zero(state.displacement.size());
  double work = 0.0;
  double lost = 0.0;
  for (int step = 1; step <= 40; ++step) {
    const integrate::State before = state;
    const Vector load_before = load;
    // A few freedoms, held ones among them, up and down again.
    for (const Eigen::Index d : {0, 40, 71, 80})
      load[d] = 1e-3 * static_cast<double>(d % 7) * (step < 20 ? step : 40 - step);
    shown.begin(state, time_step, integrate::MemoryRule::exact);
    ASSERT_TRUE(shown.linearise(state.displacement, load));
    const Vector end = shown.base();
    shown.finish(state, end, load);
    for (Eigen::Index d = 0; d < load.size(); ++d) alone.press(d, load[d]);
    alone.pass(rest, time_step);
    work += 0.5 * (load_before + load).dot(state.displacement - before.displacement);
    lost += body.dissipated(before, state);
  }
  integrate::State found = rest;
  alone.show(found);
  const double size = state.displacement.norm();
  ASSERT_GT(size, 1e-4);
  EXPECT_LT((found.displacement - state.displacement).norm(), 1e-12 * size);  // rounding
  EXPECT_LT((found.velocity - state.velocity).norm(), 1e-11 * state.velocity.norm());
  const auto energies = alone.energies();
  const double held_energy = body.stored(state) + body.kinetic(state);
  EXPECT_NEAR(energies.work, work, 1e-10 * work);  // rounding of forty sums
  EXPECT_NEAR(energies.lost, lost, 1e-10 * work);
  EXPECT_NEAR(energies.held, held_energy, 1e-10 * work);
  if (GetParam() != Viscosity::none) {
    EXPECT_GT(lost, 1e-3 * work);
  }
}

INSTANTIATE_TEST_SUITE_P(Dampings, ModalFrames,
                         testing::Values(Viscosity::none, Viscosity::nodal_drag,
                                         Viscosity::kelvin_voigt));

TEST(ModalFramesOf, a_solid_with_branches_go_with_the_body) {
  const geometry::TetMesh mesh = test::jittered_block({1, 1, 1});
  const tissue::Network network = tissue::make_network(
      mesh, std::array{1000.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < 12; ++d) held[d] = 1;
  const tissue::ViscousLaw law{.kind = Viscosity::standard_linear_solid, .branches = {{0.1, 0.5}}};
  const scene::SpringBody body(network, tissue::Kinematics::linear, law, held);
  EXPECT_FALSE(integrate::Modal(body).passes_alone());
}

}  // namespace
}  // namespace palpate
