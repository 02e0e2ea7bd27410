// The half-space's field under Hertz's pressure against its closed form on the axis.
#include "contact/patch_field.h"

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

// The mean sinking under the pressure that loads it is 3 F / (5 E' a).
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
    sum -= own * field.displacement({r * a * std::cos(0.3), r * a * std::sin(0.3), 0.0}).z();
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

}  // namespace
}  // namespace palpate::contact
