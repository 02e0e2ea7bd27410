// A step of central differences on springs is what its equations say, dashpots turned or not.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "base/dense.h"
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
    const Eigen::MatrixXd damping = test::dense(other.dashpots(before).split(block.held));
    method.step(state, load);
    Eigen::MatrixXd left = time_step * damping;
    left.diagonal() += 2.0 * body.mass();
    const bool first = step == 0;
    Vector right = (first ? 1.0 : 2.0) * time_step * time_step * (load - force) +
                   2.0 * body.mass().cwiseProduct(moved_before);
    if (!first) right -= time_step * damping * moved_before;
    for (std::size_t d = 0; d < block.held.size(); ++d)
      if (block.held[d] != 0) right[static_cast<Eigen::Index>(d)] = 0.0;
    const Vector want = dense::least_squares(left, right);
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

}  // namespace
}  // namespace palpate
