// A sampled wall in the simulation against Colgate and Brown's bound, and against its own roots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "contact/hertz.h"
#include "stability/measure.h"

namespace palpate::stability {
namespace {

struct Tissue {
  std::string id;
  double young_modulus, poisson_ratio;
};
// Chen 2007, Table 1, by the rows of tests/cases/physics.csv.
const Tissue tissues[] = {{"passivity-01", 72.4e3, 0.33},
                          {"passivity-03", 1.7e10, 0.3},
                          {"passivity-04", 33.1e3, 0.45},
                          {"passivity-05", 0.8e3, 0.3}};

// dF/dh at 1 mm under the finger of 11 mm.
double stiffness_of(const Tissue& tissue) {
  const contact::Elastic finger{2050e3, 0.5};
  const contact::Elastic body{tissue.young_modulus, tissue.poisson_ratio};
  const double modulus = contact::hertz::effective_modulus(finger.compliance(), body.compliance());
  return contact::hertz::stiffness(1e-3, 0.011, modulus);
}

// The stiffness (N/m) above which the motion on the wall grows, without virtual damping and delay:
// a root of (z - 1) (z - E) + K (c_1 z + c_0) leaves the unit circle, with E = exp(-b T / m), c_1 =
// (T - (m/b)(1 - E)) / b, c_0 = ((m/b)(1 - E) - T E) / b. For b T << m it is (2 b / T) (1 + b T /
// (6 m)), slightly above the bound of Colgate and Brown, which holds for any passive hand.
// docs/theory.md [passive]
double wall_stiffness_limit(const Device& device) {
  const double b = device.sampled.damping;
  const double time = device.sampled.frame;
  const double lost = -std::expm1(-b * time / device.mass);  // 1 - E
  const double c_1 = (time - device.mass / b * lost) / b;
  const double c_0 = (device.mass / b * lost - time * (1.0 - lost)) / b;
  // Jury's criterion: product of the roots below 1, and a positive polynomial at z = -1.
  const double turning = c_0 > 0.0 ? lost / c_0 : INFINITY;
  const double flipping = c_1 > c_0 ? 2.0 * (2.0 - lost) / (c_1 - c_0) : INFINITY;
  return std::min(turning, flipping);
}

TEST(SampledWall, NeedsTheDampingOfTheBound) {
  for (const Tissue& tissue : tissues) {
    const double stiffness = stiffness_of(tissue);
    Device device;
    // A mass so heavy that it does not move far in a frame: then the bound is the limit.
    device.mass = 1e4 * stiffness * device.sampled.frame * device.sampled.frame;
    const auto lacks = [&](double damping) {
      device.sampled.damping = damping;
      return wall_gains_energy(device, stiffness);
    };
    const double bound = contact::needed_damping(stiffness, device.sampled);
    test::expect_case(tissue.id, bound);
    const auto measured = bisect_limit(lacks, 0.5 * bound, 100.0 * bound, 1e-3);
    ASSERT_TRUE(measured.has_value());
    EXPECT_NEAR(*measured, bound, 0.01 * bound) << tissue.id;  // what counts as growth: 0.4 %
  }
}

TEST(SampledWall, LimitIsThatOfItsRoots) {
  for (const double damping : {0.02, 0.3, 5.0, 80.0}) {
    Device device;
    device.sampled.damping = damping;
    const double theory = wall_stiffness_limit(device);
    const auto still = [&](double stiffness) { return !wall_gains_energy(device, stiffness); };
    const auto measured = bisect_limit(still, 0.3 * theory, 1e3 * theory, 1e-3);
    ASSERT_TRUE(measured) << damping;
    EXPECT_NEAR(*measured, theory, 0.01 * theory) << damping;  // growth over so many frames
    // Any hand asks for more than none.
    EXPECT_GE(theory, contact::passive_stiffness(device.sampled));
  }
  Device light;
  light.sampled.damping = 0.01;
  // b T / (6 m) above the bound where the device is sluggish; its square is excluded.
  const double x = light.sampled.damping * light.sampled.frame / light.mass;
  EXPECT_NEAR(wall_stiffness_limit(light) / contact::passive_stiffness(light.sampled),
              1.0 + x / 6.0, x * x);
}

TEST(SampledWall, ChattersBelowTheBoundAndRestsAboveIt) {
  const double stiffness = stiffness_of(tissues[0]);
  Device device;
  const double bound = contact::needed_damping(stiffness, device.sampled);
  device.sampled.damping = 2.0 * bound;
  EXPECT_EQ(chatter_share(device, stiffness, {}), 0.0);
  device.sampled.damping = 0.25 * bound;
  EXPECT_GT(chatter_share(device, stiffness, {}), 0.005);  // bounces of some hundred frames
}

}  // namespace
}  // namespace palpate::stability
