// Several measurements, one answer: what one press cannot tell, two of different size can.
#include <gtest/gtest.h>

#include <cmath>

#include "identify_scenes.h"

namespace palpate {
namespace {

using identify::CurveKind;

// A ball on a bonded layer of 5 mm.
test::IdentifyScene layer_press(const std::string& radius) {
  return {"layer press",
          "[tissue]\nviscosity = \"none\"\npoisson_ratio = 0.45\nyoung_modulus = \"20 kPa\"\n"
          "base = \"bonded\"\nshape = { kind = \"cuboid\", size = [\"100 mm\", \"100 mm\", \"5 "
          "mm\"] }\n[finger]\nmaterial = \"rigid\"\nradius = \"" +
              radius +
              "\"\n[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\nrate = \"1 mm/s\"\n[output]\n"
              "interval = \"4 ms\"\n",
          {},
          {},
          {},
          CurveKind::force_travel};
}

// Presses of these scenes, with noise of 1 %, under common unknowns.
struct Joint {
  std::vector<test::IdentifyScene> scenes;
  std::vector<std::string> unknowns;
  std::vector<identify::Measurement> clean = {};

  identify::Identification found(std::uint64_t seed, const identify::IdentifyOptions& options) {
    if (clean.empty())
      for (const auto& scene : scenes) clean.push_back(test::clean_curve(scene));
    std::vector<scenario::Family> families;
    std::vector<identify::Measurement> noisy;
    families.reserve(scenes.size());
    std::vector<const scenario::Scenario*> scenarios;
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      families.push_back(scenario::parse(scenes[k].text, "test.toml", {}));
      scenarios.push_back(&families.back().cases.front().scenario);
      noisy.push_back(test::noisy(clean[k], 0.01, 100 * seed + k));
    }
    std::vector<identify::Pair> pairs;
    for (std::size_t k = 0; k < scenes.size(); ++k) pairs.push_back({&noisy[k], &families[k]});
    return identify::identify(pairs, identify::read_unknowns(unknowns, scenarios), options);
  }
};

const std::vector<std::string> elastic{"tissue.young_modulus=5..100 kPa",
                                       "tissue.poisson_ratio=0.2..0.499"};

TEST(IdentifyJoint, TwoRadiiPartModulusAndPoissonsRatio) {
  Joint joint{{layer_press("2 mm"), layer_press("20 mm")}, elastic};
  int young = 0;
  int poisson = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto found = joint.found(seed, {.searches = 1, .model_error = false, .profiles = false});
    const auto inside = [&](std::size_t i, double truth) {
      const identify::Interval interval = identify::trusted(found.unknowns[i]);
      return interval.low && *interval.low <= truth && truth <= *interval.high ? 1 : 0;
    };
    young += inside(0, 20.0);
    poisson += inside(1, 0.45);
  }
  // 38 of 40 are expected; fewer than 34 are found once in a hundred times.
  EXPECT_GE(young, 37);
  EXPECT_GE(poisson, 37);
}

TEST(IdentifyJoint, OneRadiusDoesNot) {
  for (const char* radius : {"2 mm", "20 mm"}) {
    Joint one{{layer_press(radius)}, elastic};
    const auto found = one.found(1, {.profiles = false});
    EXPECT_TRUE(found.unknowns[0].inseparable && found.unknowns[1].inseparable) << radius;
    ASSERT_EQ(found.combinations.size(), 1U);
    // The combination's interval contains its truth and the model's stated error.
    EXPECT_GT(found.combinations[0].ci95_high / found.combinations[0].estimate,
              1.0 + *found.predicted_error);
  }
  // The power law holds near the best fit; its interval contains the truth all the same.
  Joint wide{{layer_press("20 mm")}, elastic};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto found = wide.found(seed, {.searches = 1});
    ASSERT_EQ(found.combinations.size(), 1U);
    const identify::Combination& one = found.combinations[0];
    ASSERT_EQ(one.exponents.size(), 2U);
    const double truth = std::pow(20.0, one.exponents[0]) * std::pow(0.45, one.exponents[1]);
    EXPECT_LE(one.ci95_low, truth) << seed;
    EXPECT_GE(one.ci95_high, truth) << seed;
  }
  // The same press twice says no more than once.
  Joint twice{{layer_press("2 mm"), layer_press("2 mm")}, elastic};
  const auto found = twice.found(1, {.profiles = false});
  EXPECT_TRUE(found.unknowns[0].inseparable && found.unknowns[1].inseparable);
}

// A test with forty times the noise of another adds little to what both say.
TEST(IdentifyJoint, EachTestWeighsByItsOwnNoise) {
  const test::IdentifyScene scene = test::identify_scene("hertz");
  const identify::Measurement clean = test::clean_curve(scene);
  const identify::Measurement good = test::noisy(clean, 0.002, 1);
  const identify::Measurement bad = test::noisy(clean, 0.08, 2);
  const auto family = scenario::parse(scene.text, "test.toml", {});
  const auto& one = family.cases.front().scenario;
  const std::vector<const scenario::Scenario*> both{&one, &one};
  const identify::IdentifyOptions options{.model_error = false, .profiles = false};
  const std::vector<std::string> asked{"tissue.young_modulus=1..500 kPa",
                                       "contact_point@all=-0.1..0.6 mm"};
  const auto alone = identify::identify(good, family, identify::read_unknowns(asked, one), options);
  const auto joint = identify::identify({{&good, &family}, {&bad, &family}},
                                        identify::read_unknowns(asked, both), options);
  // The errors of the two add as the inverse squares of their noise.
  EXPECT_NEAR(*joint.unknowns[0].std_error / *alone.unknowns[0].std_error, 1.0, 0.2);
}

// A model's error widens every interval, also where the force falls as the unknown grows.
TEST(IdentifyJoint, TheModelsErrorWidensTheIntervalOfAThickness) {
  Joint joint{{layer_press("20 mm")}, {"tissue.shape.size.3=3..9 mm"}};
  const auto width = [&](bool error) {
    const identify::Interval interval = identify::trusted(
        joint.found(1, {.searches = 1, .model_error = error, .profiles = false}).unknowns[0]);
    return *interval.high - *interval.low;
  };
  EXPECT_GT(width(true), width(false));
}

// A sensor that shows 1.2 times the force 0.05 s late, beside a good one on the same tissue.
TEST(IdentifyJoint, GainAndDelayOfASensor) {
  test::IdentifyScene hold = test::identify_scene("viscous branch");
  Joint joint{{hold, hold},
              {"tissue.young_modulus=1..500 kPa", "force_gain@2=0.5..2", "force_delay@2=0..0.2 s"}};
  for (auto& scene : joint.scenes) joint.clean.push_back(test::clean_curve(scene));
  identify::Measurement& late = joint.clean[1];
  for (double& x : late.x) x += 0.05;
  for (double& y : late.y) y *= 1.2;
  for (auto& scene : joint.scenes) {
    const std::string line = "viscosity";
    scene.text.insert(scene.text.find(line), "young_modulus = \"60 kPa\"\n");
  }
  const auto found = joint.found(3, {.searches = 1, .profiles = false});
  ASSERT_EQ(found.unknowns.size(), 3U);
  EXPECT_EQ(found.unknowns[1].unknown.name(), "force_gain@2");
  for (const auto& [i, truth] : {std::pair{0U, 60e3}, std::pair{1U, 1.2}, std::pair{2U, 0.05}}) {
    const identify::Identified& one = found.unknowns[i];
    ASSERT_TRUE(one.ci95_low && one.ci95_high) << i;
    EXPECT_LE(*one.ci95_low, truth) << i;
    EXPECT_GE(*one.ci95_high, truth) << i;
    EXPECT_NEAR(one.estimate, truth, 0.05 * truth) << i;  // noise of 1 %
  }
  EXPECT_EQ(found.pairs.size(), 2U);
}

// Each of two records begins one row after its step, and its first row is taken as the step.
TEST(IdentifyJoint, StepsBetweenTwoRowsAreInTheInterval) {
  test::IdentifyScene scene = test::identify_scene("relaxation");
  // So short that what two records leave open adds up.
  scene.text.replace(scene.text.find("20 ms"), 5, "4 ms");
  const scenario::Family family = scenario::parse(scene.text, "test.toml", {});
  std::vector<identify::Measurement> late(2, test::clean_curve(scene));
  const std::vector<const scenario::Scenario*> scenarios(2, &family.cases[0].scenario);
  const double gap = late[0].x[1] - late[0].x[0];
  for (std::size_t k = 0; k < late.size(); ++k) {
    late[k] = test::noisy(late[k], 0.0005, k + 1);
    late[k].x.pop_back();
    late[k].y.erase(late[k].y.begin());
  }
  const auto ratio = [&] {
    const std::vector<identify::Pair> pairs{{&late[0], &family}, {&late[1], &family}};
    const auto found = identify::identify(pairs, identify::read_unknowns(scene.unknowns, scenarios),
                                          {.searches = 1});
    return identify::trusted(found.unknowns[2]);
  };
  EXPECT_LT(*ratio().high, 2.0);
  late[0].starts = {-gap};
  const double one_is_open = *ratio().high;
  late[1].starts = {-gap};
  EXPECT_GT(*ratio().high, 2.0);
  EXPECT_LT(one_is_open, *ratio().high);
}

TEST(IdentifyJoint, NamesOfUnknowns) {
  const auto one = scenario::parse(layer_press("2 mm").text, "a.toml", {});
  const auto two = scenario::parse(layer_press("20 mm").text, "b.toml", {});
  const std::vector<const scenario::Scenario*> both{&one.cases.front().scenario,
                                                    &two.cases.front().scenario};
  const auto unknowns =
      identify::read_unknowns({"tissue.young_modulus=5..100 kPa", "contact_point=0..1 mm",
                               "force_gain@all=0.5..2", "tissue.poisson_ratio@each=0.2..0.4"},
                              both);
  std::string names;
  for (const auto& each : unknowns) names += each.name() + " ";
  EXPECT_EQ(names,
            "tissue.young_modulus contact_point@1 contact_point@2 force_gain "
            "tissue.poisson_ratio@1 tissue.poisson_ratio@2 ");
  EXPECT_THROW((void)identify::read_unknowns({"contact_point@3=0..1 mm"}, both), InputError);
  EXPECT_THROW(
      (void)identify::read_unknowns({"contact_point=0..1 mm", "contact_point@2=0..1 mm"}, both),
      InputError);
}

// 40 000 rows are averaged; estimate and interval are those of all rows.
TEST(IdentifyJoint, LongRecordsAreAveraged) {
  test::IdentifyScene scene = test::identify_scene("hertz");
  identify::Measurement longer = test::clean_curve(scene);
  longer.x.clear();
  longer.y.clear();
  const double most =
      4.0 / 3.0 * 60e3 / (1.0 - 0.45 * 0.45) * std::sqrt(0.01) * std::pow(2e-3, 1.5);
  test::Noise noise(7);
  for (int i = 0; i < 40000; ++i) {
    const double x = 2.2e-3 * i / 40000.0;
    const double h = std::max(x - 0.2e-3, 0.0);
    longer.x.push_back(x);
    longer.y.push_back(most * std::pow(h / 2e-3, 1.5) + 0.01 * most * noise.normal());
  }
  const auto found =
      test::identified(scene, longer, {.searches = 1, .model_error = false, .profiles = false},
                       {"finger.radius=10 mm", "solver.model=hertz"});
  EXPECT_LT(found.x.size(), 6000U);
  const identify::Identified& young = found.unknowns[0];
  EXPECT_NEAR(young.estimate, 60e3, 4.0 * *young.std_error);
  // sigma / sqrt(sum (dF/dlnE)^2 minus what the contact point takes), by the integrals of h^3, h^2
  // and h: the correlation of h^(3/2) and 3/2 h^(1/2) is sqrt(8/9).
  const double expected =
      0.01 * std::sqrt(4.0 / (40000.0 * 2.0 / 2.2)) / std::sqrt(1.0 - 8.0 / 9.0);
  EXPECT_NEAR(*young.std_error / 60e3, expected, 0.05 * expected);
  EXPECT_NEAR(found.noise, 0.01 * most, 0.05 * 0.01 * most);  // of one row
}

}  // namespace
}  // namespace palpate
