// Springs a few at a time do what the plain loops say.
#include "plain_springs.h"
#include "tissue/spring_loop.h"

#include <gtest/gtest.h>

#include "jittered_block.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using test::Dice;
using tissue::Kinematics;
using tissue::SpringLoop;
using tissue::Vector;

Vector scattered(Eigen::Index size, double most, Dice& dice) {
  Vector u(size);
  for (double& component : u) component = 2.0 * most * (dice.roll() - 0.5);
  return u;
}

void expect_close(const Vector& got, const Vector& want) {
  ASSERT_EQ(got.size(), want.size());
  ASSERT_GT(want.norm(), 0.0);
  // Directions are products with 1 / length in another order.
  EXPECT_LE((got - want).cwiseAbs().maxCoeff(), 1e-14 * want.cwiseAbs().maxCoeff());
}

class SpringLoopOf : public testing::TestWithParam<Kinematics> {
 protected:
  geometry::TetMesh mesh_ = test::jittered_block({2, 3, 3});
  tissue::Network network_ = tissue::make_network(
      mesh_, std::array{1000.0}, tissue::van_gelder_stiffness(mesh_, std::array{15e3}));
  SpringLoop loop_{network_, GetParam()};
  Dice dice_{3};
};

TEST_P(SpringLoopOf, elastic_springs) {
  ASSERT_NE(network_.ends.size() % SpringLoop::chunk, 0U);  // the last chunk is not full
  for (int twice = 0; twice < 2; ++twice) {
    const Vector u = scattered(3 * network_.nodes(), 1e-3, dice_);
    Vector force;
    const double stored = loop_.elastic(u, force);
    expect_close(force, test::elastic_force(network_, GetParam(), u));
    const double want = test::elastic_energy(network_, GetParam(), u);
    EXPECT_NEAR(stored, want, 1e-13 * want);
  }
}

TEST_P(SpringLoopOf, elongations_to_the_bit_and_pulls) {
  const Vector u = scattered(3 * network_.nodes(), 1e-3, dice_);
  Vector elongation(network_.springs());
  Vector want(network_.springs());
  loop_.elongations(u, {elongation.data(), network_.ends.size()});
  test::elongations(network_, GetParam(), u, {want.data(), network_.ends.size()});
  EXPECT_EQ(elongation, want);
  const Vector tension = scattered(network_.springs(), 1.0, dice_);
  const std::span<const double> tensions(tension.data(), network_.ends.size());
  Vector force;
  loop_.pull(u, tensions, force);
  Vector plain;
  test::gather_forces(network_, GetParam(), u, tensions, plain);
  expect_close(force, plain);
}

TEST_P(SpringLoopOf, rates_along_directions_that_have_turned) {
  const Vector u = scattered(3 * network_.nodes(), 1e-3, dice_);
  const Vector v = scattered(u.size(), 1.0, dice_);
  Vector rate(network_.springs());
  loop_.rates(u, v, {rate.data(), network_.ends.size()});
  tissue::Network turned = network_;
  tissue::directions(network_, GetParam(), u, turned.direction);
  Vector want(network_.springs());
  test::elongations(turned, Kinematics::linear, v, {want.data(), network_.ends.size()});
  expect_close(rate, want);
}

INSTANTIATE_TEST_SUITE_P(kinematics, SpringLoopOf,
                         testing::Values(Kinematics::nonlinear, Kinematics::squared),
                         [](const auto& one) {
                           return std::string(one.param == Kinematics::squared ? "squared"
                                                                               : "nonlinear");
                         });

}  // namespace
}  // namespace palpate
