// Spreading and coupling on a flat: sums, moments, the scalar equation.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "contact/coupling.h"
#include "contact/hertz.h"
#include "geometry/cuboid.h"

namespace palpate {
namespace {

using contact::Coupling;
using contact::FlatContact;

struct Block {
  geometry::TetMesh mesh =
      geometry::cuboid(Vec3(0.06, 0.06, 0.03), {7, 6, 4}, geometry::CellPattern::mirrored);
  geometry::FlatTop top{mesh, 0.03};
  Vec3 centre{0.03, 0.03, 0.03};
};

TEST(Spread, SumsToOneAndCentresOnTheContact) {
  const Block block;
  for (const double radius : {0.0, 1e-4, 3e-3, 8e-3, 0.02}) {
    const auto spread = contact::spread_over_flat(block.top, block.centre, radius);
    double sum = 0.0;
    Vec3 centre = Vec3::Zero();
    for (std::size_t j = 0; j < spread.nodes.size(); ++j) {
      EXPECT_GE(spread.shares[j], 0.0);
      sum += spread.shares[j];
      centre += spread.shares[j] * block.mesh.nodes[static_cast<std::size_t>(spread.nodes[j])];
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);                      // 96 weights from 18 printed digits
    EXPECT_LT((centre - block.centre).norm(), 1e-14);  // linear shape functions, symmetric points
  }
}

TEST(Spread, ChangesContinuouslyWithTheRadius) {
  const Block block;
  auto before = contact::spread_over_flat(block.top, block.centre, 1e-3);
  for (double radius = 1e-3; radius < 0.02; radius += 1e-5) {
    const auto now = contact::spread_over_flat(block.top, block.centre, radius);
    double change = 0.0;
    for (std::size_t j = 0; j < now.nodes.size(); ++j) {
      double old = 0.0;
      for (std::size_t i = 0; i < before.nodes.size(); ++i)
        if (before.nodes[i] == now.nodes[j]) old = before.shares[i];
      change = std::max(change, std::abs(now.shares[j] - old));
    }
    EXPECT_LT(change, 0.01);  // 10 um over nodes 10 mm apart, a point of up to 2 % passing an edge
    before = now;
  }
}

TEST(Spread, KeepsItsForceAtTheEdge) {
  const Block block;
  const auto spread = contact::spread_over_flat(block.top, Vec3(0.001, 0.03, 0.03), 5e-3);
  double sum = 0.0;
  for (const double share : spread.shares) sum += share;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Consistent, ReadsAUniformSinkingAsItself) {
  // c0 of a constant is the constant: the weights sum to 1.
  const Block block;
  const FlatContact flat(block.top, block.mesh.nodes, block.centre, Coupling::consistent, 8e4);
  for (const double radius : {0.0, 2e-3, 6e-3, 0.012}) {
    const auto reading = flat.at(radius);
    double sum = 0.0;
    for (const double weight : reading.weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-12) << radius;  // rounding
    EXPECT_GT(reading.self, 0.0);
  }
}

TEST(Consistent, ReadingIsContinuousInTheRadius) {
  const Block block;
  const FlatContact flat(block.top, block.mesh.nodes, block.centre, Coupling::consistent, 8e4);
  double before = flat.at(1e-4).self;
  for (double radius = 1e-4; radius < 0.012; radius += 1e-5) {
    const double now = flat.at(radius).self;
    EXPECT_NEAR(now / before, 1.0, 0.02) << radius;  // 10 um against a spacing of 9 mm
    before = now;
  }
}

TEST(OneWay, ReadsNothing) {
  const Block block;
  const FlatContact flat(block.top, block.mesh.nodes, block.centre, Coupling::one_way, 8e4);
  const auto reading = flat.at(3e-3);
  EXPECT_TRUE(reading.nodes.empty());
  EXPECT_EQ(reading.self, 0.0);
}

TEST(Penetration, SolvesItsEquation) {
  EXPECT_TRUE(rc::check([] {
    const contact::SphereLaw law{0.011, 1e5};
    const double approach = 1e-6 * *rc::gen::inRange(1, 3000);
    const double compliance = 1e-5 * *rc::gen::inRange(0, 1000);
    const auto h = contact::penetration(law, approach, compliance);
    RC_ASSERT(h.has_value());
    const double back = *h + compliance * contact::hertz::force(*h, law.radius, law.modulus);
    RC_ASSERT(std::abs(back - approach) <= 1e-13 * approach + 1e-20);
  }));
}

TEST(Penetration, NegativeComplianceUntilNothingBalances) {
  const contact::SphereLaw law{0.011, 1e5};
  const auto some = contact::penetration(law, 1e-3, -2e-4);
  ASSERT_TRUE(some.has_value());
  EXPECT_GT(*some, 1e-3);
  EXPECT_NEAR(*some - 2e-4 * contact::hertz::force(*some, law.radius, law.modulus), 1e-3, 1e-15);
  EXPECT_FALSE(contact::penetration(law, 3e-3, -2e-3).has_value());
}

TEST(Penetration, NothingAboveTheSurface) {
  const contact::SphereLaw law{0.011, 1e5};
  EXPECT_EQ(contact::penetration(law, 0.0, 1e-3), 0.0);
  EXPECT_EQ(contact::penetration(law, -1e-3, 1e-3), 0.0);
}

}  // namespace
}  // namespace palpate
