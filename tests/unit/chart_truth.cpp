// What a chart measures by: which reference serves what, and that it says its own error.
#include "chart/truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contact/hertz.h"
#include "scenario_text.h"
#include "scene/estimates.h"
#include "scene/scene.h"

namespace palpate::chart {
namespace {

const std::atomic<bool> never = false;

Asked asked(const std::string& text) { return read_for_chart("scene.toml", text, {}); }

Truth truth(const std::string& text, std::size_t of_case = 0) {
  return find_truth(asked(text), of_case, never, [](const std::string&) {}).value();
}

TEST(ChartReference, AHalfSpaceHasHertz) {
  const Truth found = truth(scenario::press +
                            "[tissue]\nshape = { kind = \"half_space\" }\n[contact]\nviscosity = "
                            "\"none\"\ndepth = \"hertz\"\n");
  EXPECT_EQ(found.kind, "closed form");
  const scenario::Case one =
      scenario::read_case(scenario::press + "[tissue]\nshape = { kind = \"half_space\" }\n");
  const scene::Finger finger = scene::make_finger(scene::choose(one).chosen);
  const double force = contact::hertz::force(0.002, finger.whole.radius, finger.whole.modulus);
  EXPECT_NEAR(found.moments.back().value, force, 1e-12 * force);  // rounding of the travel
  EXPECT_NE(found.sentence.find("finite strain, which would change it"), std::string::npos);
}

TEST(ChartReference, AWideFlatHasTheLayer) {
  const std::string text = scenario::press +
                           "[tissue]\nshape = { kind = \"cuboid\", size = [\"200 mm\", \"200 mm\", "
                           "\"30 mm\"] }\n";
  const Truth found = truth(text);
  EXPECT_EQ(found.kind, "closed form");
  const scene::Estimates estimated = scene::choose(scenario::read_case(text)).expected;
  EXPECT_DOUBLE_EQ(found.moments.back().error / found.moments.back().value,
                   estimated.sides + estimated.inertia);
}

// What inertia adds to the strain, relative to the final one. Without a Poisson's ratio the block
// is a rod, held at one end and loaded at the other; each of its modes is an oscillator.
double inertia_of_rod(double time, double frequency, double retardation) {
  double sum = 0.0;
  for (int k = 1; k < 200; k += 2) {
    const double own = k * frequency;
    const double decay = 0.5 * own * own * retardation;  // above `own` in this test
    const double root = std::sqrt(decay * decay - own * own);
    const double slow = own * own / (decay + root);
    const double fast = decay + root;
    const double rest =
        (fast * std::exp(-slow * time) - slow * std::exp(-fast * time)) / (fast - slow);
    sum += 8.0 / std::pow(k * std::numbers::pi, 2) * (std::exp(-time / retardation) - rest);
  }
  return sum;
}

struct Creeping {
  double density = 0.0;  // kg/m^3
  const char* base = "";
  const char* kind = "";
  double error = 0.0;  // of the strain of 0.01
};

// A heavy block moves so much that `quasi_static` would be wrong. On a bonded base the reference
// knows no law, and finds the same on meshes.
TEST(ChartReference, CreepIsTheMaterialsWithItsInertia) {
  for (const Creeping& block : {Creeping{1e3, "frictionless", "closed form", 2e-6},
                                Creeping{2e4, "frictionless", "closed form", 3e-5},
                                Creeping{2e4, "bonded", "refined", 3e-5}}) {
    const Truth found = truth(
        "[tissue]\nviscosity = \"kelvin_voigt\"\nretardation_time = \"0.1 s\"\nyoung_modulus = "
        "\"10 kPa\"\npoisson_ratio = 0\ndensity = \"" +
        std::to_string(block.density) + " kg/m^3\"\nbase = \"" + block.base +
        "\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n"
        "[[step]]\nkind = \"creep\"\nstress = \"0.1 kPa\"\nload_time = \"0.5 s\"\n"
        "recovery_time = \"0.5 s\"\n[output]\ninterval = \"10 ms\"\n");
    EXPECT_EQ(found.kind, block.kind);
    ASSERT_EQ(found.moments.size(), 50U);  // 20 ms, of which 4 ms and 10 ms are parts
    const double frequency = 0.5 * std::numbers::pi / 0.03 * std::sqrt(1e4 / block.density);
    double inertia = 0.0;
    for (const Moment& moment : found.moments) {
      const double before = moment.time - 0.5;
      const double added = 0.01 * (inertia_of_rod(moment.time, frequency, 0.1) -
                                   (before > 0.0 ? inertia_of_rod(before, frequency, 0.1) : 0.0));
      const double law = 0.01 * (-std::expm1(-moment.time / 0.1) +
                                 (before > 0.0 ? std::expm1(-before / 0.1) : 0.0));
      inertia = std::max(inertia, std::abs(added));
      EXPECT_NEAR(moment.value, law + added, moment.error) << moment.time;
      EXPECT_LT(moment.error, block.error);
    }
    EXPECT_GT(inertia, 1e-8 * block.density) << "the reference sees waves that the law does not";
  }
}

TEST(ChartReference, WavesThatRingAreNotLeftOut) {
  // An elastic block that is loaded at once rings for ever: no law of the material says how.
  const Truth found = truth(
      "[tissue]\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"20 mm\", \"20 "
      "mm\", \"20 mm\"] }\n[[step]]\nkind = \"creep\"\nload_time = \"4 ms\"\nrecovery_time "
      "= \"0 s\"\n");
  EXPECT_EQ(found.kind, "refined");
  EXPECT_GT(own_error(scenario::read_one(scenario::creep), found.moments).greatest, 0.0);
  double most = 0.0;
  for (const Moment& moment : found.moments) most = std::max(most, moment.value);
  EXPECT_GT(most, 1.3 * 1e3 / 72.4e3) << "it overshoots stress over modulus";
}

TEST(ChartReference, StoppedItSaysNothing) {
  const std::atomic<bool> stopped = true;
  EXPECT_FALSE(find_truth(asked(scenario::creep), 0, stopped, [](const std::string&) {}));
}

}  // namespace
}  // namespace palpate::chart
