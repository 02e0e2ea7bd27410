// Texts of `--unknown`: what is read, and what is refused in which words.
#include "identify/unknowns.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "refusal.h"
#include "scenario/family.h"
#include "scenario/scenario.h"

namespace palpate::identify {
namespace {

const std::string press =
    "[tissue]\n[[region]]\nkind = \"slab\"\ntop = \"5 mm\"\nmaterial = \"muscle\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n";

scenario::Scenario read_press() {
  return scenario::parse(press, "press.toml", {}).cases.at(0).scenario;
}

std::string refusal(const std::vector<std::string>& texts) {
  return test::refusal([&] { return read_unknowns(texts, read_press()); });
}

TEST(Unknowns, AreReadWithTheirUnits) {
  const auto unknowns =
      read_unknowns({"tissue.young_modulus=1 kPa..200 kPa", "tissue.shape.size.3=5..20 mm",
                     "tissue.poisson_ratio=0.1..0.49", "region.1.top=1..9 mm",
                     "contact_point=-0.5..0.5 mm", "force_offset=-10..10 mN", "step.1.to=1..3 mm"},
                    read_press());
  ASSERT_EQ(unknowns.size(), 7U);
  EXPECT_EQ(unknowns[0].low, 1e3);
  EXPECT_EQ(unknowns[0].high, 200e3);
  EXPECT_EQ(unknowns[0].scale, Unknown::Scale::logarithmic);
  EXPECT_EQ(unknowns[1].low, 0.005);
  EXPECT_EQ(unknowns[2].scale, Unknown::Scale::linear);
  EXPECT_EQ(unknowns[4].what, Unknown::What::contact_point);
  EXPECT_EQ(unknowns[4].low, -0.0005);
  EXPECT_EQ(unknowns[5].high, 0.01);
  EXPECT_DOUBLE_EQ(unknowns[0].value(0.5), std::sqrt(1e3 * 200e3));
  EXPECT_DOUBLE_EQ(unknowns[2].value(0.5), 0.295);
  for (const Unknown& one : unknowns) {
    EXPECT_NEAR(one.inverse(one.value(0.3)), 0.3, 1e-12);  // rounding
    const double d = 1e-6;
    EXPECT_NEAR(one.slope(0.3), (one.value(0.3 + d) - one.value(0.3 - d)) / (2.0 * d),
                1e-6 * std::abs(one.slope(0.3)));  // central difference
  }
}

TEST(Unknowns, SetTheScenario) {
  scenario::Scenario scenario = read_press();
  const auto unknowns = read_unknowns(
      {"tissue.shape.size.3=5..20 mm", "region.1.top=1..9 mm", "tissue.young_modulus=1..9 kPa"},
      scenario);
  set_unknowns(scenario, unknowns, std::vector{0.011, 0.002, 7e3});
  EXPECT_EQ(std::get<scenario::Cuboid>(scenario.tissue.shape).size[2], 0.011);
  EXPECT_EQ(std::get<scenario::Slab>(scenario.regions[0].part).top, 0.002);
  EXPECT_EQ(scenario.tissue.young_modulus, 7e3);
  EXPECT_FALSE(scenario::set_number(scenario, "tissue.no_such", 1.0));
}

TEST(Unknowns, AreRefusedInSentences) {
  EXPECT_EQ(refusal({"tissue.young_modulus"}),
            "palpate: `--unknown tissue.young_modulus` is written `KEY=LOW..HIGH`, as "
            "`tissue.young_modulus=1 kPa..200 kPa`");
  EXPECT_EQ(refusal({"tissue.young_modulos=1..2 kPa"}),
            "palpate: `--unknown tissue.young_modulos=1..2 kPa` names no number of this scenario; "
            "did you mean `tissue.young_modulus`?");
  EXPECT_EQ(refusal({"tissue.young=1..2 kPa"}),
            "palpate: `--unknown tissue.young=1..2 kPa` names no number of this scenario; did you "
            "mean `tissue.young_modulus`?");
  EXPECT_EQ(refusal({"yong_modulus"}),
            "palpate: `--unknown yong_modulus` names no number of this scenario; did you mean "
            "`tissue.young_modulus`?");
  EXPECT_NE(refusal({"=1..2 kPa"}).find("is written `KEY=LOW..HIGH`"), std::string::npos);
  EXPECT_NE(refusal({"tissue.young_modulus=1 kPa"}).find("is written `KEY=LOW..HIGH`"),
            std::string::npos);
  EXPECT_NE(refusal({"tissue.young_modulus=1..2 mm"}).find("mm"), std::string::npos);
  EXPECT_EQ(refusal({"tissue.poisson_ratio=0.1..0.6"}),
            "palpate: `--unknown tissue.poisson_ratio=0.1..0.6` leaves the limits of the key, "
            "which is above -1 and below 0.5; narrow the range");
  EXPECT_EQ(refusal({"tissue.poisson_ratio=0.4..0.1"}),
            "palpate: `--unknown tissue.poisson_ratio=0.4..0.1` wants a lower bound below the "
            "upper one; exchange the two");
  EXPECT_NE(refusal({"tissue.relaxation_time=1..2 s"}).find("that is used with `viscosity = "),
            std::string::npos);
  EXPECT_EQ(
      refusal({"contact_point=0..1 mm", "contact_point=0..2 mm"}),
      "palpate: `--unknown contact_point=0..2 mm` is given twice; keep one of the two ranges");
}

}  // namespace
}  // namespace palpate::identify
