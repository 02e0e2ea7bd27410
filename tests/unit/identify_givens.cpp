// Texts of `--given`, and what a number that is known to a deviation adds to an interval.
#include "identify/unknowns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/identify.h"
#include "refusal.h"
#include "scenario/family.h"

namespace palpate::identify {
namespace {

// A sphere on a half-space: F = 4/3 E/(1-nu^2) sqrt(R) h^(3/2), with 1 % of alternating noise.
const std::string sphere =
    "[tissue]\nshape = { kind = \"half_space\" }\npoisson_ratio = 0.45\nyoung_modulus = \"60 "
    "kPa\"\n[finger]\nmaterial = \"rigid\"\nradius = \"11 mm\"\n[contact]\ndepth = \"hertz\"\n"
    "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"1 mm/s\"\n";

scenario::Family sphere_family() { return scenario::parse(sphere, "sphere.toml", {}); }

std::string refused_given(const std::string& text, const std::vector<Unknown>& unknowns = {}) {
  const scenario::Family family = sphere_family();
  return test::refusal([&] { (void)read_givens({text}, family.cases.front().scenario, unknowns); });
}

TEST(Givens, AreReadWithTheirUnits) {
  scenario::Family family = sphere_family();
  const auto givens =
      read_givens({"finger.radius=11.5 mm +- 0.2 mm", "tissue.poisson_ratio = 0.4 \u00b1 0.02"},
                  family.cases.front().scenario, {});
  ASSERT_EQ(givens.size(), 2U);
  EXPECT_DOUBLE_EQ(givens[0].value, 0.0115);
  EXPECT_DOUBLE_EQ(givens[0].deviation, 2e-4);
  EXPECT_DOUBLE_EQ(givens[1].value, 0.4);
  EXPECT_DOUBLE_EQ(givens[1].deviation, 0.02);
  set_givens(family, givens);
  EXPECT_DOUBLE_EQ(family.cases.front().scenario.finger.radius, 0.0115);
  EXPECT_DOUBLE_EQ(*family.cases.front().scenario.tissue.poisson_ratio, 0.4);
}

TEST(Givens, AreRefusedInSentences) {
  const std::string written = "is written `KEY=VALUE +- SD`, as `finger.radius=11 mm +- 0.2 mm`";
  for (const char* text : {"finger.radius=11 mm", "11 mm +- 0.2 mm", "11 +- 1 = finger.radius"})
    EXPECT_NE(refused_given(text).find(written), std::string::npos) << refused_given(text);
  EXPECT_NE(refused_given("finger.radiu=11 mm +- 1 mm").find("did you mean `finger.radius`?"),
            std::string::npos);
  EXPECT_NE(refused_given("finger.radius=11 mm +- 0 mm").find("wants a deviation above 0"),
            std::string::npos);
  EXPECT_NE(refused_given("tissue.poisson_ratio=0.49 +- 0.02")
                .find("leaves the limits of the key within its deviation"),
            std::string::npos);
  EXPECT_NE(refused_given("tissue.poisson_ratio=high +- 0.02").find("wants pure numbers"),
            std::string::npos);
  const auto unknowns =
      read_unknowns({"finger.radius=5..20 mm"}, sphere_family().cases.front().scenario);
  EXPECT_NE(refused_given("finger.radius=11 mm +- 1 mm", unknowns).find("names an unknown"),
            std::string::npos);
}

// E goes as R^(-1/2): 2 % of the radius are 1 % of E, which add in squares on the logarithmic scale
// of a modulus, to the ends of the profile as well.
TEST(Givens, WidenEveryEnd) {
  scenario::Family family = sphere_family();
  Measurement curve{.x = {},
                    .y = {},
                    .x_name = "travel",
                    .y_name = "force",
                    .x_dimension = {1, 0, 0},
                    .y_dimension = {1, 1, -2}};
  for (int i = 1; i <= 100; ++i) {
    curve.x.push_back(2e-5 * i);
    curve.y.push_back(4.0 / 3.0 * 60e3 / (1.0 - 0.45 * 0.45) * std::sqrt(0.011) *
                      std::pow(curve.x.back(), 1.5) * (i % 2 == 0 ? 1.01 : 0.99));
  }
  const auto unknowns =
      read_unknowns({"tissue.young_modulus=5..500 kPa"}, family.cases.front().scenario);
  const auto givens =
      read_givens({"finger.radius=11 mm +- 0.22 mm"}, family.cases.front().scenario, unknowns);
  for (const Noise noise : {Noise::constant, Noise::relative}) {
    const Identification before = identify(curve, family, unknowns, {.noise = noise});
    Identification after = before;
    carry_givens(after, curve, family, givens, noise);
    const Identified& one = before.unknowns[0];
    const Identified& wide = after.unknowns[0];
    const double part = 1.959964 * after.givens.at(0).deviations.at(0) / one.estimate;
    EXPECT_NEAR(part, 0.0196, 1e-4);
    for (const auto& [end, was] : {std::pair{wide.ci95_low, one.ci95_low},
                                   {wide.ci95_high, one.ci95_high},
                                   {wide.profile_low, one.profile_low},
                                   {wide.profile_high, one.profile_high}}) {
      ASSERT_TRUE(end && was);
      const double away = std::log(*was / one.estimate);
      EXPECT_NEAR(std::log(*end / one.estimate), std::copysign(std::hypot(away, part), away), 1e-6);
    }
  }
  // Of an unknown that the data leave open there is nothing to widen.
  const auto inseparable =
      read_unknowns({"tissue.young_modulus=5..500 kPa", "tissue.poisson_ratio=0.2..0.49"},
                    family.cases.front().scenario);
  Identification open = identify(curve, family, inseparable, {});
  carry_givens(open, curve, family, givens, Noise::constant);
  for (const Identified& one : open.unknowns) {
    EXPECT_TRUE(one.inseparable);
    EXPECT_FALSE(one.std_error || one.ci95_low || one.ci95_high);
  }
}

}  // namespace
}  // namespace palpate::identify
