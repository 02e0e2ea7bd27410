// Stick and slip on a body that moves otherwise than a half-space.
#include "contact/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mindlin.h"

namespace palpate::contact::friction {
namespace {

constexpr double limit = 0.2;      // N
constexpr double radius = 3e-3;    // m
constexpr double softness = 6e-5;  // 1/Pa
constexpr double stick_compliance = softness / (8.0 * radius);

// Tangential tensors of the plane z = 0 relative to Mindlin's compliance at rest.
std::vector<Eigen::Matrix3d> bodies() {
  std::vector<Eigen::Matrix3d> all;
  for (const auto& [xx, yy, xy] :
       {std::array{0.3, 0.3, 0.0}, {-0.5, -0.5, 0.0}, {0.4, -0.3, 0.2}}) {
    Eigen::Matrix3d one = Eigen::Matrix3d::Zero();
    one.topLeftCorner<2, 2>() << xx, xy, xy, yy;
    all.emplace_back(stick_compliance * one);
  }
  return all;
}

Vec3 pulled(Vec3 stretch, const Eigen::Matrix3d& body) {
  return drag(stretch, limit, radius, softness, body);
}

TEST(Friction, AddsTheBodysDisplacementToMindlins) {
  for (const Eigen::Matrix3d& body : bodies())
    for (const double part : {1e-9, 0.1, 0.5, 0.9}) {
      const Vec3 stretch = part * limit * stick_compliance * Vec3(0.8, 0.6, 0.0);
      const Vec3 force = pulled(stretch, body);
      ASSERT_LT(force.norm(), limit);
      const test::Stick half_space = test::stick(force.norm(), limit, radius, softness);
      const Vec3 moved = half_space.displacement * force.normalized() + body * force;
      // stick() subtracts nearly equal numbers.
      EXPECT_LT((moved - stretch).norm(), (1e-12 + 1e-15 / part) * stretch.norm()) << part;
    }
}

TEST(Friction, OfABodyLikeAHalfSpaceIsMindlins) {
  for (const double part : {0.1, 1.0, 1.49, 1.51, 3.0}) {
    const Vec3 stretch = part * limit * stick_compliance * Vec3(0.8, 0.6, 0.0);
    const Eigen::Matrix3d nearly = 1e-14 * bodies().front();
    Vec3 one = stretch;
    Vec3 other = stretch;
    const Vec3 want = drag(one, limit, radius, softness);
    EXPECT_LT((drag(other, limit, radius, softness, nearly) - want).norm(), 1e-12 * limit);
    EXPECT_LT((one - other).norm(), 1e-12 * stretch.norm());
  }
}

TEST(Friction, GrowsWithTheStretchUpToTheLimit) {
  for (const Eigen::Matrix3d& body : bodies()) {
    double before = 0.0;
    for (int i = 1; i <= 400; ++i) {
      const double force =
          pulled(0.01 * i * limit * stick_compliance * Vec3(0.8, 0.6, 0.0), body).norm();
      EXPECT_GE(force, before * (1.0 - 1e-14));
      EXPECT_LE(force, limit * (1.0 + 1e-14));
      before = force;
    }
    EXPECT_NEAR(before, limit, 1e-14 * limit);
  }
}

// A slide in one direction ends with a drag along it, whatever the body's axes and the stretch at
// the start; a slip that goes on changes neither.
TEST(Friction, PointsAlongTheSlip) {
  const Vec3 way(0.6, -0.8, 0.0);
  for (const Eigen::Matrix3d& body : bodies()) {
    Vec3 stretch = limit * stick_compliance * Vec3(1.0, 1.0, 0.0);
    Vec3 force;
    for (int i = 0; i < 200; ++i) {
      stretch += 0.1 * limit * stick_compliance * way;
      force = drag(stretch, limit, radius, softness, body);
    }
    EXPECT_LT((force - limit * way).norm(), 1e-4 * limit);  // it turns ever more slowly
    const Vec3 kept = stretch;
    (void)drag(stretch, limit, radius, softness, body);
    EXPECT_LT((stretch - kept).norm(), 1e-12 * kept.norm());
  }
}

// A closed path without slip does no work: the derivative of the force is symmetric.
TEST(Friction, HasAPotentialWithoutSlip) {
  const double step = 1e-4 * limit * stick_compliance;
  for (const Eigen::Matrix3d& body : bodies()) {
    const Vec3 stretch = 0.4 * limit * stick_compliance * Vec3(0.8, 0.6, 0.0);
    Eigen::Matrix2d slope;
    for (int axis = 0; axis < 2; ++axis)
      slope.col(axis) = (pulled(stretch + step * Vec3::Unit(axis), body) -
                         pulled(stretch - step * Vec3::Unit(axis), body))
                            .head<2>() /
                        (2.0 * step);
    EXPECT_NEAR(slope(0, 1), slope(1, 0), 1e-6 * slope.norm());  // of the step, squared
    EXPECT_GT(slope.determinant(), 0.0);
  }
}

// A body that would move against the load is taken to be five times as stiff as a half-space.
TEST(Friction, OfABodyTooStiffIsThatOfFiveHalfSpaces) {
  Eigen::Matrix3d body = Eigen::Matrix3d::Zero();
  body(0, 0) = body(1, 1) = -1.5 * stick_compliance;
  const Vec3 stretch = 1e-3 * limit * stick_compliance * Vec3::UnitX();
  EXPECT_NEAR(pulled(stretch, body).x() * stick_compliance / stretch.x(), 5.0,
              0.03);  // not at rest
}

}  // namespace
}  // namespace palpate::contact::friction
