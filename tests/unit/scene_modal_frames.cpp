// Frames in modes alone are the steps that the body is shown at, and keep its account of energy.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "base/dense.h"
#include "base/stop_scope.h"
#include "integrate/modal.h"
#include "jittered_block.h"
#include "scene/spring_body.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Vector;
using tissue::Viscosity;

constexpr double frame_time = 1e-3;  // s

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
    shown.begin(state, frame_time, integrate::MemoryRule::exact);
    ASSERT_TRUE(shown.linearise(state.displacement, load));
    const Vector end = shown.base();
    shown.finish(state, end, load);
    for (Eigen::Index d = 0; d < load.size(); ++d) alone.press(d, load[d]);
    alone.pass(rest, frame_time);
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

// A block of 125 nodes, 300 of whose degrees of freedom are free, with its statics.
class LowestModes : public testing::Test {
 protected:
  LowestModes() {
    held_.assign(3 * mesh_.nodes.size(), 0);
    for (std::size_t d = 0; d < held_.size(); ++d) held_[d] = mesh_.nodes[d / 3].z() < 1e-9 ? 1 : 0;
    body_.emplace(network_, tissue::Kinematics::linear,
                  tissue::ViscousLaw{.kind = Viscosity::kelvin_voigt, .time = 0.01}, held_);
    EXPECT_TRUE(statics_.prepare(tissue::stiffness_matrix(network_), held_));
    load_ = Vector::Zero(3 * network_.nodes());
    for (Eigen::Index d = 200; d < load_.size(); d += 7) load_[d] = 1e-3 * static_cast<double>(d);
  }

  geometry::TetMesh mesh_ = test::jittered_block({4, 4, 4});
  tissue::Network network_ = tissue::make_network(
      mesh_, std::array{1000.0}, tissue::van_gelder_stiffness(mesh_, std::array{15e3}));
  std::vector<char> held_;
  std::optional<scene::SpringBody> body_;
  SymmetricSolver statics_;
  Vector load_;
};

TEST_F(LowestModes, are_those_of_a_dense_solver) {
  const Eigen::MatrixXd stiffness = Eigen::MatrixXd(body_->stiffness().split(body_->held()).local);
  std::vector<double> all;
  // Held rows are those of the identity; a mass far below any other keeps them out of the lowest.
  Vector mass = body_->mass();
  for (std::size_t d = 0; d < held_.size(); ++d)
    if (held_[d] != 0) mass[static_cast<Eigen::Index>(d)] = 1e-20;
  const Vector scale = mass.cwiseSqrt().cwiseInverse();
  const Vector squares =
      dense::symmetric_modes(scale.asDiagonal() * stiffness * scale.asDiagonal()).values;
  for (const Eigen::Index count : {5, 40, 100, 250}) {
    const integrate::Modal lowest(*body_, count, statics_);
    ASSERT_EQ(lowest.modes(), count);
    EXPECT_FALSE(lowest.keeps_all());
    const double squared = squares[count - 1];
    EXPECT_NEAR(lowest.highest() * lowest.highest(), squared, 1e-7 * squared);  // Lanczos: 1e-9
  }
}

TEST_F(LowestModes, and_the_others_have_exact_statics_together) {
  const integrate::Modal all(*body_);
  Vector whole, few, others;
  all.kept(load_, whole);
  all.dropped(load_, others);
  EXPECT_EQ(others.norm(), 0.0);
  for (const Eigen::Index count : {5, 100}) {
    const integrate::Modal lowest(*body_, count, statics_);
    lowest.kept(load_, few);
    lowest.dropped(load_, others);
    EXPECT_LT((few + others - whole).norm(), 1e-9 * whole.norm());  // rounding, statics are exact
    EXPECT_GT(others.norm(), 0.01 * whole.norm());
  }
}

// The matrix is Eigen's, which no signal ends; a child of the program computes it.
TEST_F(LowestModes, are_not_waited_for_by_a_signal) {
  const std::atomic<bool> signal = true;
  const StopScope scope(signal);
  EXPECT_THROW(integrate::Modal all(*body_), Stopped);
}

// What is known is taken for the same body only.
TEST_F(LowestModes, are_known_when_a_body_is_run_again) {
  const integrate::Modal all(*body_);
  integrate::KnownModes known;
  Vector whole, again;
  all.kept(load_, whole);
  for (int run = 0; run < 2; ++run) {
    integrate::Modal(*body_, &known).kept(load_, again);
    EXPECT_EQ(again, whole);
  }
  EXPECT_GT(known.seconds, 0.0);
  EXPECT_EQ(known.saved, known.seconds);
  known.squares *= 4.0;
  EXPECT_DOUBLE_EQ(integrate::Modal(*body_, &known).highest(), 2.0 * all.highest());
  const tissue::Network stiffer = tissue::make_network(
      mesh_, std::array{1000.0}, tissue::van_gelder_stiffness(mesh_, std::array{30e3}));
  const scene::SpringBody other(stiffer, tissue::Kinematics::linear,
                                tissue::ViscousLaw{.kind = Viscosity::kelvin_voigt, .time = 0.01},
                                held_);
  EXPECT_EQ(integrate::Modal(other, &known).highest(), integrate::Modal(other).highest());
}

TEST_F(LowestModes, move_as_they_do_among_all) {
  integrate::State rest;
  rest.displacement = rest.velocity = Vector::Zero(load_.size());
  rest.memory = body_->memory_at(rest.displacement);
  integrate::Modal all(*body_);
  integrate::Modal lowest(*body_, 100, statics_);
  // A load in the span of the lowest modes moves nothing else: K times what they sink in statics.
  Vector sunk, image;
  lowest.kept(load_, sunk);
  body_->force(sunk, body_->memory_at(sunk), image);
  for (int step = 0; step < 30; ++step) {
    for (Eigen::Index d = 0; d < image.size(); ++d) {
      all.press(d, held_[as_index(d)] != 0 ? 0.0 : image[d]);
      lowest.press(d, held_[as_index(d)] != 0 ? 0.0 : image[d]);
    }
    all.pass(rest, frame_time);
    lowest.pass(rest, frame_time);
  }
  integrate::State of_all = rest;
  integrate::State of_few = rest;
  all.show(of_all);
  lowest.show(of_few);
  ASSERT_GT(of_all.displacement.norm(), 0.1 * sunk.norm());
  EXPECT_LT((of_all.displacement - of_few.displacement).norm(), 1e-6 * sunk.norm());  // Lanczos
}

}  // namespace
}  // namespace palpate
