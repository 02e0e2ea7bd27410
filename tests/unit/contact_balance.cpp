// Penetrations that balance: one scalar equation, and several contacts against Newton's method.
#include "base/dense.h"
#include "contact/balance.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "contact/hertz.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using contact::PointLaw;
using Eigen::Index;
using test::Dice;

// A sphere of 11 mm on 100 kPa.
const PointLaw law{contact::hertz::force(1.0, 0.011, 1e5)};

TEST(PointLaw, IsHertzs) {
  EXPECT_NEAR(law.force(1e-3) / contact::hertz::force(1e-3, 0.011, 1e5), 1.0, 1e-15);
  EXPECT_NEAR(law.stiffness(1e-3) / contact::hertz::stiffness(1e-3, 0.011, 1e5), 1.0, 1e-15);
  EXPECT_EQ(law.force(0.0), 0.0);
  EXPECT_EQ(law.force(-1e-3), 0.0);
  EXPECT_EQ(law.stiffness(-1e-3), 0.0);
}

TEST(Penetration, SolvesItsEquation) {
  EXPECT_TRUE(rc::check([] {
    const double approach = 1e-6 * *rc::gen::inRange(1, 3000);
    const double compliance = 1e-5 * *rc::gen::inRange(0, 1000);
    const auto h = contact::penetration(law, approach, compliance);
    RC_ASSERT(h.has_value());
    const double back = *h + compliance * law.force(*h);
    RC_ASSERT(std::abs(back - approach) <= 1e-13 * approach + 1e-20);
  }));
}

TEST(Penetration, NegativeComplianceUntilNothingBalances) {
  const auto some = contact::penetration(law, 1e-3, -2e-4);
  ASSERT_TRUE(some.has_value());
  EXPECT_GT(*some, 1e-3);
  EXPECT_NEAR(*some - 2e-4 * law.force(*some), 1e-3, 1e-15);
  EXPECT_FALSE(contact::penetration(law, 3e-3, -2e-3).has_value());
}

TEST(Penetration, NothingAboveTheSurface) {
  EXPECT_EQ(contact::penetration(law, 0.0, 1e-3), 0.0);
  EXPECT_EQ(contact::penetration(law, -1e-3, 1e-3), 0.0);
}

TEST(Balance, OneContactIsTheScalarEquation) {
  for (const double compliance : {-1e-4, 0.0, 1e-3}) {
    const Eigen::MatrixXd own = Eigen::MatrixXd::Constant(1, 1, compliance);
    double depth = 5e-4;
    ASSERT_TRUE(contact::balance({&law, 1}, std::array{1e-3}, own, {&depth, 1}));
    EXPECT_EQ(depth, *contact::penetration(law, 1e-3, compliance));
  }
}

// Eight contacts on a ring press each other as points on a half-space do.
TEST(Balance, AlikeContactsPressAlike) {
  constexpr int count = 8;
  Eigen::MatrixXd compliance(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      compliance(i, j) =
          i == j ? 2e-4 : 1e-4 / std::abs(std::sin(3.14159265358979324 * (i - j) / count));
  const std::vector<PointLaw> laws(count, law);
  const std::vector<double> approaches(count, 1e-3);
  std::vector<double> depths(count, 1e-3);
  ASSERT_TRUE(contact::balance(laws, approaches, compliance, depths));
  for (const double depth : depths) EXPECT_NEAR(depth / depths[0], 1.0, 1e-14);  // rounding
  // All alike, so one equation with the row's sum.
  EXPECT_NEAR(depths[0] / *contact::penetration(law, 1e-3, compliance.row(0).sum()), 1.0, 1e-13);
}

// Contacts at random places of a half-space, 1 / (pi E' r) apart and 2 mm wide themselves, some of
// them above the surface.
struct Bed {
  std::vector<PointLaw> laws;
  std::vector<double> approaches;
  Eigen::MatrixXd compliance;
};
Bed make_bed(unsigned seed) {
  Dice dice(seed);
  const int count = 2 + static_cast<int>(6.0 * dice.roll());
  Bed bed;
  std::vector<Vec3> places;
  for (int i = 0; i < count; ++i) {
    bed.laws.push_back({law.coefficient * (0.5 + dice.roll())});
    bed.approaches.push_back(1.5e-3 * (dice.roll() - 0.3));
    places.emplace_back(0.03 * dice.roll(), 0.03 * dice.roll(), 0.0);
  }
  bed.compliance.resize(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const double apart =
          (places[static_cast<std::size_t>(i)] - places[static_cast<std::size_t>(j)]).norm();
      bed.compliance(i, j) = 1.0 / (3.14159265358979324 * 1e5 * std::max(apart, 0.002));
    }
  return bed;
}

// Newton's method for x_i + sum_j C_ij F_j(x_j) = g_i in signed x, halving steps that do not help.
std::vector<double> newton(const Bed& bed) {
  const auto n = static_cast<Index>(bed.laws.size());
  Eigen::VectorXd h(n);
  for (Index i = 0; i < n; ++i)
    h[i] = std::max(0.0, 0.3 * bed.approaches[static_cast<std::size_t>(i)]);
  // x_i below 0 carries no force: F(x) = 0 there, and x_i is then just how far it stays clear.
  const auto residual = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd r(n);
    for (Index i = 0; i < n; ++i) {
      r[i] = x[i] - bed.approaches[static_cast<std::size_t>(i)];
      for (Index j = 0; j < n; ++j)
        r[i] += bed.compliance(i, j) * bed.laws[static_cast<std::size_t>(j)].force(x[j]);
    }
    return r;
  };
  for (int k = 0; k < 200; ++k) {
    const Eigen::VectorXd r = residual(h);
    Eigen::MatrixXd slope = Eigen::MatrixXd::Identity(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        slope(i, j) += bed.compliance(i, j) * bed.laws[static_cast<std::size_t>(j)].stiffness(h[j]);
    const Eigen::VectorXd move = -dense::least_squares(slope, r);
    double part = 1.0;
    while (part > 1e-6 && residual(h + part * move).norm() > r.norm()) part *= 0.5;
    h += part * move;
    if (move.norm() <= 1e-16) break;
  }
  std::vector<double> depths;
  for (Index i = 0; i < n; ++i) depths.push_back(std::max(0.0, h[i]));
  return depths;
}

TEST(Balance, AgreesWithNewtonsMethodAndPullsNowhere) {
  int open = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Bed bed = make_bed(seed);
    std::vector<double> depths(bed.laws.size(), 0.0);
    ASSERT_TRUE(contact::balance(bed.laws, bed.approaches, bed.compliance, depths)) << seed;
    const auto expected = newton(bed);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      EXPECT_NEAR(depths[i], expected[i], 1e-12) << seed;  // of depths of 1e-3, conditioned at 100
      // h >= 0; where it is 0 the skin, sunken as the others make it, is clear of the sphere.
      double left = depths[i] - bed.approaches[i];
      for (std::size_t j = 0; j < depths.size(); ++j)
        left += bed.compliance(static_cast<Index>(i), static_cast<Index>(j)) *
                bed.laws[j].force(depths[j]);
      EXPECT_GE(depths[i], 0.0);
      EXPECT_GE(left, -1e-15);
      if (depths[i] > 0.0) {
        EXPECT_NEAR(left, 0.0, 1e-15);
      } else if (bed.approaches[i] > 0.0) {
        ++open;
      }
    }
  }
  EXPECT_GT(open, 0);  // some sphere was lifted off by its neighbours, else nothing is tested
}

TEST(Balance, DoesNotDependOnTheFirstGuess) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Bed bed = make_bed(seed);
    std::vector<double> from_nothing(bed.laws.size(), 0.0);
    std::vector<double> from_far(bed.laws.size(), 5e-3);
    ASSERT_TRUE(contact::balance(bed.laws, bed.approaches, bed.compliance, from_nothing));
    ASSERT_TRUE(contact::balance(bed.laws, bed.approaches, bed.compliance, from_far));
    for (std::size_t i = 0; i < from_far.size(); ++i)
      EXPECT_NEAR(from_far[i], from_nothing[i], 1e-14) << seed;
  }
}

TEST(Balance, SaysWhenNothingBalances) {
  const Eigen::MatrixXd stiff = Eigen::MatrixXd::Constant(1, 1, -2e-3);
  double depth = 0.0;
  EXPECT_FALSE(contact::balance({&law, 1}, std::array{3e-3}, stiff, {&depth, 1}));
}

}  // namespace
}  // namespace palpate
