// What a chart measures by: which reference serves what, and that it says its own error.
#include "chart/truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/hertz.h"
#include "scenario_text.h"
#include "scene/estimates.h"
#include "scene/scene.h"

namespace palpate::chart {
namespace {

const std::atomic<bool> never = false;

Asked asked(const std::string& text) {
  return {"scene.toml", text, {}, scenario::parse(text, "scene.toml", {})};
}

Truth truth(const std::string& text, std::size_t of_case = 0) {
  return find_truth(asked(text), of_case, never, [](const std::string&) {}).value();
}

TEST(ChartReference, AHalfSpaceHasHertz) {
  const Truth found = truth(scenario::press +
                            "[tissue]\nshape = { kind = \"half_space\" }\n[contact]\nviscosity = "
                            "\"none\"\n");
  EXPECT_EQ(found.kind, "closed form");
  const scenario::Case one =
      scenario::read_case(scenario::press + "[tissue]\nshape = { kind = \"half_space\" }\n");
  const scene::Finger finger = scene::make_finger(scene::choose(one).chosen);
  const double force = contact::hertz::force(0.002, finger.whole.radius, finger.whole.modulus);
  EXPECT_NEAR(found.moments.back().value, force, 1e-12 * force);  // rounding of the travel
  EXPECT_GT(found.moments.back().error, 0.0) << "a deep press is not Hertz's";
}

TEST(ChartReference, AWideFlatHasTheLayer) {
  const std::string text = scenario::press +
                           "[tissue]\nshape = { kind = \"cuboid\", size = [\"200 mm\", \"200 mm\", "
                           "\"30 mm\"] }\n";
  const Truth found = truth(text);
  EXPECT_EQ(found.kind, "closed form");
  const scene::Estimates estimated = scene::estimate(scene::choose(scenario::read_case(text)));
  EXPECT_DOUBLE_EQ(found.moments.back().error / found.moments.back().value,
                   estimated.sides + estimated.inertia);
}

TEST(ChartReference, CreepIsTheMaterials) {
  const Truth found = truth(
      "[tissue]\nviscosity = \"kelvin_voigt\"\nretardation_time = \"0.1 s\"\nyoung_modulus = \"10 "
      "kPa\"\n[[step]]\nkind = \"creep\"\nstress = \"0.1 kPa\"\nload_time = \"0.5 "
      "s\"\nrecovery_time = \"0.5 s\"\n[output]\ninterval = \"10 ms\"\n");
  EXPECT_EQ(found.kind, "closed form");
  ASSERT_EQ(found.moments.size(), 100U);
  const double end = 0.01 * -std::expm1(-5.0);
  for (const Moment& moment : found.moments) {
    const double exact = moment.time <= 0.5 ? 0.01 * -std::expm1(-moment.time / 0.1)
                                            : end * std::exp(-(moment.time - 0.5) / 0.1);
    EXPECT_NEAR(moment.value, exact, 1e-12) << moment.time;  // rounding
    EXPECT_GT(moment.error, 0.0);
    EXPECT_LT(moment.error, 0.01 * end) << "inertia adds little to so slow a creep";
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
