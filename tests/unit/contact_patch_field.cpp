// The half-space's field under a contact: closed forms, and the laws of elasticity.
#include "contact/patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::contact {
namespace {

// sigma_z = -p0 / (1 + z^2/a^2) below the middle (K. L. Johnson 1985, eq. (3.45)), p0 = 3 F / (2 pi
// a^2), and u_r = 0 there.
TEST(PatchField, IsHertzsOnTheAxis) {
  constexpr double a = 2e-3;
  const PatchField field(a, a, {.shear_modulus = 1e4, .poisson_ratio = 0.4});
  const double p0 = 3.0 / (2.0 * std::numbers::pi * a * a);
  for (const double depth : {0.3, 0.5, 1.0, 2.0, 2.9, 3.1, 7.0, 9.0, 30.0}) {
    const FieldValue value = field.at({0.0, 0.0, -depth * a});
    const double want = -p0 / (1.0 + depth * depth);
    EXPECT_NEAR(value.stress(2, 2) / want, 1.0, 2e-3) << depth;
    EXPECT_NEAR(value.stress(0, 2) / want, 0.0, 1e-12) << depth;
    EXPECT_NEAR(value.displacement.x() / value.displacement.z(), 0.0, 1e-12) << depth;
  }
}

// The mean surface displacement under the pressure that loads it is 3 F / (5 E' a).
TEST(PatchField, SinksAsHertzsContactOnTheAverage) {
  constexpr double a = 2e-3;
  constexpr double nu = 0.3;
  constexpr double shear = 1e4;
  const PatchField field(a, a, {.shear_modulus = shear, .poisson_ratio = nu}, 4);
  double sum = 0.0;
  double weight = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double r = (i + 0.5) / 40.0;
    const double own = r * std::sqrt(1.0 - r * r);
    sum -= own * field.at({r * a * std::cos(0.3), r * a * std::sin(0.3), 0.0}).displacement.z();
    weight += own;
  }
  const double plane_modulus = 2.0 * shear * (1.0 + nu) / (1.0 - nu * nu);
  EXPECT_NEAR(sum / weight * 5.0 * plane_modulus * a / 3.0, 1.0, 0.02);
}

TEST(PatchField, OfAnEllipseTurnsWithItsAxes) {
  const HalfSpace tissue{.shear_modulus = 1e4, .poisson_ratio = 0.45};
  const PatchField along(3e-3, 2e-3, tissue);
  const PatchField across(2e-3, 3e-3, tissue);
  const FieldValue one = along.at({4e-3, 1e-3, -2e-3});
  const FieldValue other = across.at({-1e-3, 4e-3, -2e-3});
  EXPECT_NEAR(one.stress(0, 0) / other.stress(1, 1), 1.0, 1e-3);
  EXPECT_NEAR(one.displacement.z() / other.displacement.z(), 1.0, 1e-4);
}

// Along -z and two directions of the plane.
const std::vector<Vec3> directions{-Vec3::UnitZ(), Vec3::UnitX(), Vec3(0.6, -0.8, 0.0)};
constexpr HalfSpace soft{.shear_modulus = 1e4, .poisson_ratio = 0.4};

TEST(PatchField, StressFollowsFromTheDisplacementByHookesLaw) {
  constexpr double step = 1e-6;
  const double lame =
      2.0 * soft.shear_modulus * soft.poisson_ratio / (1.0 - 2.0 * soft.poisson_ratio);
  for (const Vec3& along : directions) {
    const PatchField field(2e-3, 3e-3, soft, 1, along);
    for (const Vec3& point : {Vec3(1e-3, -2e-3, -2e-3), Vec3(-6e-3, 7e-3, -9e-3),
                              Vec3(0.0, 5e-3, -4e-3), Vec3(30e-3, 20e-3, -3e-3)}) {
      Eigen::Matrix3d gradient;
      for (int axis = 0; axis < 3; ++axis)
        gradient.col(axis) = (field.at(point + step * Vec3::Unit(axis)).displacement -
                              field.at(point - step * Vec3::Unit(axis)).displacement) /
                             (2.0 * step);
      const Eigen::Matrix3d stress = lame * gradient.trace() * Eigen::Matrix3d::Identity() +
                                     soft.shear_modulus * (gradient + gradient.transpose());
      const Eigen::Matrix3d got = field.at(point).stress;
      // Of the step, squared; and rounding.
      EXPECT_LT((got - stress).norm(), 1e-5 * got.norm()) << along.transpose();
    }
  }
}

TEST(PatchField, TractionsOnAHemisphereBalanceTheLoad) {
  for (const Vec3& along : directions)
    for (const double radius : {5e-3, 12e-3, 40e-3}) {
      const PatchField field(2e-3, 3e-3, soft, 1, along);
      constexpr int parts = 60;
      Vec3 force = Vec3::Zero();
      Vec3 moment = Vec3::Zero();
      for (int i = 0; i < parts; ++i)
        for (int j = 0; j < 2 * parts; ++j) {
          const double height = -(i + 0.5) / parts;
          const double angle = std::numbers::pi * (j + 0.5) / parts;
          const double flat = std::sqrt(1.0 - height * height);
          const Vec3 normal(flat * std::cos(angle), flat * std::sin(angle), height);
          const double area = std::numbers::pi * radius * radius / (parts * parts);
          const Vec3 traction = area * (field.at(radius * normal).stress * normal);
          force += traction;
          moment += radius * normal.cross(traction);
        }
      // By the midpoints of 60 rings.
      EXPECT_LT((force + along).norm(), 1e-3) << along.transpose() << " at " << radius;
      EXPECT_LT(moment.norm(), 1e-3 * radius) << along.transpose() << " at " << radius;
    }
}

TEST(PatchField, LeavesTheSurfaceFreeOutsideThePatch) {
  for (const Vec3& along : directions) {
    const PatchField field(2e-3, 3e-3, soft, 1, along);
    for (const Vec3& point : {Vec3(2.5e-3, 0.0, 0.0), Vec3(-3e-3, 4e-3, 0.0)}) {
      const Eigen::Matrix3d stress = field.at(point).stress;
      EXPECT_LT(stress.col(2).norm(), 1e-12 * stress.norm());
    }
  }
}

// Betti: what a load along one direction moves another place along a second one, the second load
// there moves the first place along the first.
TEST(PatchField, IsSymmetricBetweenLoads) {
  const Vec3 apart(4e-3, -7e-3, 0.0);
  for (const Vec3& first : directions)
    for (const Vec3& second : directions) {
      const PatchField one(2e-3, 2e-3, soft, 1, first);
      const PatchField other(2e-3, 2e-3, soft, 1, second);
      const double there = one.at(apart).displacement.dot(second);
      const double here = other.at(-apart).displacement.dot(first);
      EXPECT_NEAR(there, here, 1e-9 * one.at(apart).displacement.norm());  // rounding
    }
}

// The mean displacement along the traction that loads it is 3 (2 - nu) / (20 G a), and that of the
// middle 3 (2 - nu) / (16 G a).                docs/theory.md [stick], tangential loads
TEST(PatchField, MovesAsMindlinsContactOnTheAverage) {
  constexpr double a = 2e-3;
  const PatchField field(a, a, soft, 6, Vec3::UnitX());
  double sum = 0.0;
  double weight = 0.0;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 16; ++j) {
      const double r = (i + 0.5) / 40.0;
      const double angle = std::numbers::pi * (j + 0.3) / 8.0;
      const double own = r * std::sqrt(1.0 - r * r);
      sum += own * field.at(r * a * Vec3(std::cos(angle), std::sin(angle), 0.0)).displacement.x();
      weight += own;
    }
  const double unit = (2.0 - soft.poisson_ratio) / (soft.shear_modulus * a);
  EXPECT_NEAR(sum / weight / unit, 0.15, 0.02 * 0.15);  // points near point loads
  EXPECT_NEAR(field.at(Vec3::Zero()).displacement.x() / unit, 3.0 / 16.0, 0.02 * 3.0 / 16.0);
}

}  // namespace
}  // namespace palpate::contact
