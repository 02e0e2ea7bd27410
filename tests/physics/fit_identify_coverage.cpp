// Synthetic curves with 1 % noise: the truth is inside the 95 % interval as often as that says.
#include <gtest/gtest.h>

#include <cmath>

#include "identify_scenes.h"

namespace palpate {
namespace {

// Of n repeats, 0.95 n are inside, give or take 3 sqrt(0.95 0.05 n): a right interval fails one
// such check of 400, and the noise is the same every time. Many repeats are of
// tests/bench/coverage.cpp.
void expect_covered(const char* name, int repeats) {
  const test::IdentifyScene& scene = test::identify_scene(name);
  const std::vector<int> inside = test::covered(scene, repeats);
  const double spread = 3.0 * std::sqrt(0.95 * 0.05 * repeats);
  for (std::size_t i = 0; i < inside.size(); ++i)
    EXPECT_NEAR(inside[i], 0.95 * repeats, spread) << name << ": " << scene.unknowns[i];
}

TEST(Coverage, HertzWithItsContactPoint) { expect_covered("hertz", 1000); }
TEST(Coverage, CreepOfASpecimen) { expect_covered("creep", 400); }
TEST(Coverage, RelaxationOfASpecimen) { expect_covered("relaxation", 400); }
TEST(Coverage, Layer) { expect_covered("layer", 60); }
TEST(Coverage, ViscousBranch) { expect_covered("viscous branch", 20); }
TEST(Coverage, FrictionOfASlide) { expect_covered("slide", 60); }
TEST(Coverage, Springs) { expect_covered("mass_spring", 3); }
TEST(Coverage, CoupledSprings) { expect_covered("coupled_springs", 3); }
TEST(Coverage, CreepOfSprings) { expect_covered("creep of springs", 6); }

}  // namespace
}  // namespace palpate
