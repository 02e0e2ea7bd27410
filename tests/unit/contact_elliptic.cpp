// Elliptic contact: against Hertz's circle, the half-space's own integrals and 60-digit references.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

constexpr double modulus = 78902.5;      // Pa
constexpr double finger_radius = 0.011;  // m
constexpr double depth = 1e-3;           // m

double force(const EllipticLaw& law, double h) {
  return hertz::force(h, law.force_radius, modulus);
}

EllipticLaw law(double kappa_1, double kappa_2) {
  const auto found = elliptic_law(finger_radius, kappa_1, kappa_2);
  EXPECT_TRUE(found.has_value()) << kappa_1 << " " << kappa_2;
  return found.value_or(EllipticLaw{});
}

// 1/R_1 + kappa = 1 and r: every length in units of 1/(2 A).
EllipticLaw unit_law(double r) { return elliptic_law(1.0, 0.0, r - 1.0).value(); }

TEST(Elliptic, IsHertzOnEqualCurvatures) {
  for (const double kappa : {-45.0, -20.0, 0.0, 1e-3, 50.0, 200.0}) {
    const double radius = hertz::effective_radius(finger_radius, kappa);
    const EllipticLaw circle = law(kappa, kappa);
    EXPECT_EQ(circle.axis_ratio, 1.0);
    EXPECT_DOUBLE_EQ(circle.force_radius, radius);
    EXPECT_DOUBLE_EQ(circle.along_radius, radius);
  }
}

// q = 1 - 2/3 e, R_a = 1 + e/6 and R_F = 1 - e/2 to first order in e = B/A - 1; what is left is
// of second order, with factors below 1.
TEST(Elliptic, ComesToTheCircleWithoutLoss) {
  for (double e = 1e-3; e > 1e-15; e /= 7.0) {
    const double r = 1.0 + e;
    const double got = r - 1.0;
    const double bound = got * got + 1e-15;  // and rounding
    EXPECT_NEAR(unit_law(r).axis_ratio, 1.0 - 2.0 / 3.0 * got, bound) << e;
    EXPECT_NEAR(unit_law(r).along_radius, 1.0 + got / 6.0, bound) << e;
    EXPECT_NEAR(unit_law(r).force_radius, 1.0 - got / 2.0, bound) << e;
  }
}

// Roots of [E/(1-m) - K]/(K - E) = B/A and what follows from them, to 60 digits (mpmath).
TEST(Elliptic, ReferencesFromCircleToLine) {
  struct Row {
    double ratio, axes, along, force;
  };
  const Row rows[] = {{1.25, 0.86180336834379414, 1.0371392797809334, 0.89628351066758224},
                      {2.0, 0.6305957014280997, 1.1140187760436524, 0.72131005136431266},
                      {3.0, 0.48262778112325235, 1.1773094382908543, 0.60663535879302382},
                      {5.0, 0.34599908663735574, 1.2511128337681153, 0.49640082973654609},
                      {10.0, 0.22224951924622138, 1.3387342441827888, 0.38895075384620822},
                      {1e2, 0.054984018057118764, 1.5357158861678934, 0.20593881414920626},
                      {1e4, 0.0041248573583856217, 1.709190642953474, 0.089171640347558914},
                      {1e8, 3.0449128970768588e-5, 1.8303035098238549, 0.032512367795104571},
                      {1e16, 2.2187955586223706e-9, 1.9061587791071013, 0.010354428539174518},
                      {1e30, 1.6500925762465301e-16, 1.9469873219162813, 0.0033752222479215161}};
  for (const Row& row : rows) {
    const EllipticLaw got = unit_law(row.ratio);
    EXPECT_NEAR(got.axis_ratio, row.axes, 4e-15 * row.axes) << row.ratio;  // a few roundings
    EXPECT_NEAR(got.along_radius, row.along, 2e-15 * row.along) << row.ratio;
    EXPECT_NEAR(got.force_radius, row.force, 2e-15 * row.force) << row.ratio;
  }
}

// The half-space under the pressure p_0 sqrt(1 - x^2/a^2 - y^2/b^2) sinks by
//   a b p_0 / (2 E*) times the integral of (1 - x^2/(a^2+s) - y^2/(b^2+s)) / sqrt((a^2+s)(b^2+s)s)
// over s > 0 (Johnson 1985, section 3.5): it must be h - A x^2 - B y^2. With s = a b tan^2(w) the
// trapezoidal rule is exact to rounding.
TEST(Elliptic, PressureMakesTheSurfacesFit) {
  for (const double kappa : {-60.0, -30.0, 0.0, 100.0, 900.0}) {
    const EllipticLaw contact = law(kappa, 10.0);
    const double a = std::sqrt(contact.along_radius * depth);
    const double b = contact.axis_ratio * a;
    double sunk = 0.0, along = 0.0, across = 0.0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i) {
      const double w = std::numbers::pi * (i + 0.5) / n;  // twice the quarter, by symmetry
      const double c = std::cos(w) * std::cos(w);
      const double s = std::sin(w) * std::sin(w);
      const double x = a * a * c + a * b * s;
      const double y = b * b * c + a * b * s;
      const double part = std::sqrt(a * b / (x * y)) * std::numbers::pi / n;
      sunk += part;
      along += part * c / x;
      across += part * c / y;
    }
    const double peak = 1.5 * force(contact, depth) / (std::numbers::pi * a * b);
    const double factor = a * b * peak / (2.0 * modulus);
    const double least = 0.5 * (1.0 / finger_radius + std::min(kappa, 10.0));
    const double greatest = 0.5 * (1.0 / finger_radius + std::max(kappa, 10.0));
    EXPECT_NEAR(factor * sunk, depth, 1e-12 * depth);          // rounding of the sum
    EXPECT_NEAR(factor * along, least, 1e-12 * least);         // as above
    EXPECT_NEAR(factor * across, greatest, 1e-12 * greatest);  // as above
  }
}

TEST(Elliptic, PropertiesOfEveryLaw) {
  EXPECT_TRUE(rc::check([] {
    const double kappa_1 = *rc::gen::inRange(-90000, 300000) * 1e-3;
    const double kappa_2 = *rc::gen::inRange(-90000, 300000) * 1e-3;
    const EllipticLaw contact = law(kappa_1, kappa_2);
    const EllipticLaw swapped = law(kappa_2, kappa_1);
    RC_ASSERT(contact.force_radius == swapped.force_radius);
    RC_ASSERT(contact.axis_ratio <= 1.0 && contact.axis_ratio > 0.0);
    // Between the spheres of the two curvatures, and at least that of the mean.
    const auto sphere = [](double kappa) { return hertz::effective_radius(finger_radius, kappa); };
    const double slack = 1.0 + 1e-14;  // rounding where the two are equal
    RC_ASSERT(contact.force_radius <= slack * sphere(std::min(kappa_1, kappa_2)));
    RC_ASSERT(slack * contact.force_radius >= sphere(std::max(kappa_1, kappa_2)));
    RC_ASSERT(slack * contact.force_radius >= geometric_radius(finger_radius, kappa_1, kappa_2));
    RC_ASSERT(slack * geometric_radius(finger_radius, kappa_1, kappa_2) >=
              mean_radius(finger_radius, kappa_1, kappa_2));
    // A tissue that is rounder in any direction pushes less.
    RC_ASSERT(law(kappa_1 + 1.0, kappa_2).force_radius < contact.force_radius);
  }));
}

TEST(Elliptic, GoesOverIntoTheFlat) {
  const double flat = hertz::force(depth, finger_radius, modulus);
  for (const double kappa : {1e-3, 1e-6, 1e-9, -1e-9, -1e-6, -1e-3})
    // Every force radius falls by about R_1 / 2 of the one curvature, the force by half of that.
    EXPECT_NEAR(force(law(kappa, 0.0), depth) / flat, 1.0 - finger_radius * kappa / 4.0,
                finger_radius * finger_radius * kappa * kappa + 1e-15);
}

TEST(Elliptic, RefusesConformingSurfaces) {
  const double limit = -1.0 / finger_radius;
  EXPECT_FALSE(elliptic_law(finger_radius, limit, 0.0).has_value());
  EXPECT_FALSE(elliptic_law(finger_radius, 10.0, 1.01 * limit).has_value());
  EXPECT_FALSE(elliptic_law(finger_radius, 10.0, (1.0 + 1e-12) * limit).has_value());
  EXPECT_FALSE(elliptic_law(finger_radius, 2.0 * limit, 2.0 * limit).has_value());
  const double nothing = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(elliptic_law(finger_radius, nothing, 0.0).has_value());
  EXPECT_FALSE(elliptic_law(finger_radius, 0.0, nothing).has_value());
  EXPECT_FALSE(elliptic_law(finger_radius, 0.0, infinite).has_value());
  // A hair before the limit there is still an answer, and it is finite.
  const auto close = elliptic_law(finger_radius, limit * (1.0 - 1e-15), 0.0);
  ASSERT_TRUE(close.has_value());
  EXPECT_TRUE(std::isfinite(close->force_radius) && std::isfinite(close->along_radius));
  EXPECT_GT(close->axis_ratio, 0.0);

  EXPECT_FALSE(nearly_conforming(finger_radius, 0.499 * limit, 10.0));
  EXPECT_TRUE(nearly_conforming(finger_radius, 0.501 * limit, 10.0));
  EXPECT_TRUE(nearly_conforming(finger_radius, 10.0, 0.501 * limit));
}

}  // namespace
}  // namespace palpate::contact
