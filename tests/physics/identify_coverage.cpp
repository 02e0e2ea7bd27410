// Synthetic curves with 1 % noise: the truth is inside the 95 % interval as often as that says.
#include <gtest/gtest.h>

#include <cmath>

#include "identify_scenes.h"

namespace palpate {
namespace {

// P(X <= k) of n repeats that are each inside with a probability of 0.95.
double at_most(int k, int n) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(0.95) + (n - i) * std::log(0.05));
  return sum;
}

// So few or so many inside happen to a right interval once in a thousand times on either side; the
// noise is the same every time. Few repeats can show gross faults only: hundreds, of every rung,
// are in docs/identify.md, by tests/bench/coverage.cpp.
void expect_covered(const char* name, int repeats) {
  const test::IdentifyScene& scene = test::identify_scene(name);
  const std::vector<int> inside = test::covered(scene, repeats);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    EXPECT_GT(at_most(inside[i], repeats), 1e-3)
        << name << ": " << scene.unknowns[i] << ": " << inside[i];
    if (inside[i] < repeats || repeats > 200) {
      EXPECT_GT(1.0 - at_most(inside[i] - 1, repeats), 1e-3)
          << name << ": " << scene.unknowns[i] << ": " << inside[i];
    }
  }
}

TEST(Coverage, HertzWithItsContactPoint) { expect_covered("hertz", 1000); }
TEST(Coverage, CreepOfASpecimen) { expect_covered("creep", 400); }
TEST(Coverage, RelaxationOfASpecimen) { expect_covered("relaxation", 400); }
TEST(Coverage, Layer) { expect_covered("layer", 12); }
TEST(Coverage, ViscousBranch) { expect_covered("viscous branch", 20); }
TEST(Coverage, FrictionOfASlide) { expect_covered("slide", 60); }
TEST(Coverage, Springs) { expect_covered("mass_spring", 3); }
TEST(Coverage, CoupledSprings) { expect_covered("coupled_springs", 3); }
TEST(Coverage, CreepOfSprings) { expect_covered("creep of springs", 20); }

}  // namespace
}  // namespace palpate
