// Colgate and Brown's bound on the paper's tissues, and the depth where Hertz passes it.
#include "contact/passivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

constexpr double tip_radius = 0.011;  // m

struct Row {
  double young_modulus, poisson_ratio;  // Pa, of Table 1
  double damping;                       // N s/m
};

// tests/cases/physics.csv, rows passivity-01, -03, -04 and -05: h = 1 mm, T = 1 ms, to 8 digits.
constexpr Row rows[] = {{72.4e3, 0.33, 0.26169009},
                        {1.7e10, 0.3, 9.0641149},
                        {33.1e3, 0.45, 0.13559654},
                        {0.8e3, 0.3, 0.0029147766}};

double modulus_of(const Row& row) {
  return hertz::effective_modulus(Elastic{2050e3, 0.5}.compliance(),
                                  Elastic{row.young_modulus, row.poisson_ratio}.compliance());
}

TEST(Passivity, DampingThatTheTissuesOfThePaperNeed) {
  for (const Row& row : rows)
    EXPECT_NEAR(needed_damping(hertz::stiffness(1e-3, tip_radius, modulus_of(row)), {}),
                row.damping,
                5e-8 * row.damping);  // half a unit of the eighth digit
}

TEST(Passivity, VirtualDampingAndDelayAskForMore) {
  EXPECT_DOUBLE_EQ(needed_damping(1000.0, {.frame = 2e-3, .virtual_damping = -0.5}), 1.5);
  EXPECT_DOUBLE_EQ(needed_damping(1000.0, {.frame = 2e-3, .delay = 3e-3}), 4.0);
}

TEST(Passivity, DepthIsWhereTheNeededDampingIsTheDevices) {
  const SampledDevice device{.damping = 0.3, .frame = 1e-3, .virtual_damping = 0.1, .delay = 1e-4};
  for (const Row& row : rows) {
    PointLaw law;
    law.coefficient = hertz::force(1.0, tip_radius, modulus_of(row));
    const double depth = passive_depth(law, device);
    // K grows as sqrt(h)
    const double unit = hertz::stiffness(1.0, tip_radius, modulus_of(row));
    EXPECT_NEAR(depth, std::pow(passive_stiffness(device) / unit, 2), 1e-13 * depth);  // rounding
    EXPECT_NEAR(needed_damping(law.stiffness(depth), device), device.damping, 1e-13);
  }
}

TEST(Passivity, LimitsOfTheDepth) {
  PointLaw law;
  law.coefficient = 1e4;
  EXPECT_EQ(passive_depth(law, {.damping = 0.1, .virtual_damping = 0.1}), 0.0);
  EXPECT_EQ(passive_depth(law, {.damping = 1e6}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace palpate::contact
