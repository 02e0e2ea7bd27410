// Closed forms of contact against independent numbers: groups hertz, friction, series, check.
#include <gtest/gtest.h>

#include <numbers>

#include "cases.h"
#include "contact/friction.h"
#include "contact/hertz.h"
#include "material/tissue_table.h"
#include "mindlin.h"

namespace palpate {
namespace {

using contact::Elastic;
using test::expect_case;
namespace hertz = contact::hertz;

constexpr double finger_radius = 0.011;  // m

Elastic elastic(const std::string& name) {
  const auto tissue = material::find(name, "", {}).tissue;
  return {tissue.young_modulus.value, tissue.poisson_ratio.value};
}

double modulus(const std::string& name) {
  return hertz::effective_modulus(elastic("finger").compliance(), elastic(name).compliance());
}

double force(const std::string& name, double depth) {
  return hertz::force(depth, finger_radius, modulus(name));
}

TEST(HertzCases, EffectiveModulus) {
  expect_case("hertz-01", modulus("skin"));
  expect_case("hertz-10", modulus("muscle"));
  expect_case("hertz-19", modulus("bone"));
  expect_case("hertz-28", modulus("ligament"));
}

TEST(HertzCases, Force) {
  expect_case("hertz-02", force("skin", 0.5e-3));
  expect_case("hertz-07", force("skin", 2e-3));
  expect_case("hertz-11", force("muscle", 0.5e-3));
  expect_case("hertz-12", force("muscle", 1e-3));
  expect_case("hertz-20", force("bone", 0.5e-3));
  expect_case("hertz-21", force("bone", 1e-3));
  expect_case("hertz-29", force("ligament", 0.5e-3));
  expect_case("hertz-30", force("ligament", 1e-3));
}

// The five tissues at 0.5, 1, 2 and 3 mm as the design's brief predicts them from Table 1.
TEST(HertzCases, FigureSixForces) {
  struct Row {
    const char* tissue;
    double scale;
    double forces[4];
  };
  const Row rows[] = {{"skin", 1.0, {.1234, .3489, .9869, 1.813}},
                      {"muscle", 1.0, {.0111, .0315, .0891, .1637}},
                      {"ligament", 1.0, {.0639, .1808, .5114, .9394}},
                      {"bone", 0.1, {.427, 1.209, 3.418, 6.280}},
                      {"upper_leg", 1.0, {.00137, .00389, .0110, .0202}}};
  const double depths[] = {0.5e-3, 1e-3, 2e-3, 3e-3};
  for (const Row& row : rows)
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(row.scale * force(row.tissue, depths[i]), row.forces[i],
                  5e-3 * row.forces[i])  // the numbers are printed to three or four digits
          << row.tissue << " at " << depths[i];
}

TEST(HertzCases, RadiusPressureStiffness) {
  expect_case("hertz-13", hertz::contact_radius(1e-3, finger_radius));
  expect_case("hertz-40", hertz::contact_radius(1e-3, finger_radius));
  const double a = hertz::contact_radius(1e-3, finger_radius);
  expect_case("hertz-23", hertz::peak_pressure(force("bone", 1e-3), a));
  expect_case("hertz-32", hertz::peak_pressure(force("ligament", 1e-3), a));
  expect_case("hertz-41", hertz::peak_pressure(force("upper_leg", 1e-3), a));
  expect_case("hertz-06", hertz::stiffness(1e-3, finger_radius, modulus("skin")));
  expect_case("hertz-33", hertz::stiffness(1e-3, finger_radius, modulus("ligament")));
  expect_case("hertz-42", hertz::stiffness(1e-3, finger_radius, modulus("upper_leg")));
}

TEST(HertzCases, DepthAtForce) {
  expect_case("hertz-09", hertz::depth(1.75, finger_radius, modulus("skin")));
  expect_case("hertz-18", hertz::depth(1.75, finger_radius, modulus("muscle")));
  expect_case("hertz-45", hertz::depth(1.75, finger_radius, modulus("upper_leg")));
}

TEST(HertzCases, CurvedTissueAndShares) {
  const double convex = hertz::effective_radius(finger_radius, 1.0 / 0.020);
  expect_case("hertz-46", hertz::force(1e-3, convex, modulus("skin")));
  const double concave = hertz::effective_radius(finger_radius, -1.0 / 0.040);
  expect_case("hertz-47", hertz::force(1e-3, concave, modulus("skin")));
  const double finger = elastic("finger").compliance();
  expect_case("hertz-35", finger / (finger + elastic("ligament").compliance()));
}

TEST(HertzCases, EqualSpheres) {
  const double one = force("skin", 1e-3);
  const double half = hertz::force(1e-3, 0.5 * finger_radius, modulus("skin"));
  expect_case("hertz-50", half / one);
  expect_case("hertz-51", 8.0 * half / one);
}

// Radial quadrature in s = sqrt(1 - r^2/a^2), where the integrand is a polynomial.
TEST(HertzCases, PressureIntegratesToTheForce) {
  const double a = hertz::contact_radius(1e-3, finger_radius);
  const double whole = force("skin", 1e-3);
  double sum = 0.0;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n;
    sum += hertz::peak_pressure(whole, a) * s * 2.0 * std::numbers::pi * a * a * s / n;
  }
  expect_case("hertz-49", sum / whole);
}

TEST(HertzCases, ContactRadiusIsEquationThree) {
  const double f = force("skin", 1e-3);
  const double lambda = 1.0 / modulus("skin");
  EXPECT_NEAR(std::cbrt(0.75 * f * lambda * finger_radius),
              hertz::contact_radius(1e-3, finger_radius), 1e-15);  // rounding of cbrt
}

TEST(HertzCases, SeriesLosesTwoThirds) {
  const double lambda_1 = elastic("finger").compliance();
  const auto lost = [&](const std::string& name) {
    const double lambda_2 = elastic(name).compliance();
    return std::pow(1.0 + lambda_2 / (lambda_1 + lambda_2), -1.5);
  };
  expect_case("series-01", lost("skin"));
  expect_case("series-02", lost("muscle"));
  expect_case("series-03", lost("bone"));
  expect_case("series-04", lost("ligament"));
}

TEST(HertzCases, MooseExample) { expect_case("check-01", hertz::depth(1e4, 1.0, 7.5e6)); }

TEST(FrictionCases, CattaneoMindlin) {
  const auto shear = [](const Elastic& body) {
    return (2.0 - body.poisson_ratio) * 2.0 * (1.0 + body.poisson_ratio) / body.young_modulus;
  };
  const double normal = force("skin", 1e-3);
  const double limit = contact::friction::limit(0.5, normal, 0.0);
  const auto stick = test::stick(0.5 * limit, limit, hertz::contact_radius(1e-3, finger_radius),
                                 shear(elastic("finger")) + shear(elastic("skin")));
  expect_case("friction-01", stick.radius / hertz::contact_radius(1e-3, finger_radius));
  expect_case("friction-02", stick.displacement);
}

TEST(Friction, DragIsTheInverseOfStick) {
  const double limit = 2.0;
  const double radius = 3e-3;
  const double compliance = 1e-4;
  const Vec3 along = Vec3(3.0, -4.0, 0.0) / 5.0;
  for (const double force : {0.0, 0.1, 1.0, 1.99}) {
    Vec3 stretch = test::stick(force, limit, radius, compliance).displacement * along;
    const Vec3 before = stretch;
    const Vec3 drag = contact::friction::drag(stretch, limit, radius, compliance);
    EXPECT_NEAR((drag - force * along).norm(), 0.0, 1e-12 * limit);  // rounding of a cube root
    EXPECT_EQ(stretch, before);
  }
  Vec3 far = 1.0 * along;  // m
  EXPECT_NEAR((contact::friction::drag(far, limit, radius, compliance) - limit * along).norm(), 0.0,
              1e-15 * limit);  // rounding of a unit vector
  const double slip = test::stick(limit, limit, radius, compliance).displacement;
  EXPECT_NEAR(far.norm(), slip, 1e-15 * slip);  // rounding
  EXPECT_EQ(contact::friction::drag(far, 0.0, radius, compliance), Vec3::Zero());
  EXPECT_EQ(far, Vec3::Zero());
}

TEST(Friction, WeightCountsOnce) {
  EXPECT_DOUBLE_EQ(contact::friction::limit(0.3, 1.0, 0.0), 0.3);
  EXPECT_DOUBLE_EQ(contact::friction::limit(0.3, 1.0, 0.5), 0.45);
}

}  // namespace
}  // namespace palpate
