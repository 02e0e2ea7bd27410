// The factor of the body's size on formulas, against meshes and against the numbers it comes from.
#include <gtest/gtest.h>

#include <cmath>

#include "refusal.h"
#include "run_text.h"
#include "scene/estimates.h"

namespace palpate::test {
namespace {

std::string pressed(const std::string& tissue, const std::string& more = "",
                    const std::string& contact = "") {
  return "[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.4\n" + tissue +
         "[finger]\nmaterial = \"rigid\"\nradius = \"8 mm\"\n[contact]\nviscosity = \"none\"\n" +
         contact +
         "[output]\nfits = false\n[[step]]\nkind = \"indent\"\nto = \"0.8 mm\"\nrate = \"2 "
         "mm/s\"\n" +
         more;
}
const std::string narrow =
    "shape = { kind = \"cuboid\", size = [\"36 mm\", \"40 mm\", \"30 mm\"] }\n";
const std::string ball =
    "shape = { kind = \"ellipsoid\", size = [\"60 mm\", \"60 mm\", \"60 mm\"] }\n";

scene::Choice chosen(const std::string& text) {
  return scene::choose(scenario::parse(text, "test.toml", {}).cases.front());
}

TEST(SizeRatio, GrowsWithTheContactsRadius) {
  const scene::SizeRatio ratio{.change = -0.2, .deepest = 4e-3, .error = 0.01};
  EXPECT_EQ(ratio.value(0.0), 1.0);
  EXPECT_DOUBLE_EQ(ratio.value(1e-3), 0.9);
  EXPECT_DOUBLE_EQ(ratio.value(4e-3), 0.8);
  EXPECT_DOUBLE_EQ(ratio.value(9e-3), 0.8);
}

// Both formulas are off by more than the mesh says of itself, and with the factor by less.
TEST(SizeRatio, BringsFormulasToTheForceOfAMesh) {
  struct Body {
    std::string tissue, model;
  };
  for (const auto& [tissue, model] : {Body{narrow, "layer"}, Body{ball, "hertz"}}) {
    const std::string linear = "contact.depth=hertz";
    const auto of_mesh = run_text(
        pressed(tissue), {linear, "solver.model=coupled_springs", "solver.tolerance=0.01"});
    const auto half_space = run_text(pressed(tissue), {linear, "solver.model=" + model});
    const auto body =
        run_text(pressed(tissue), {linear, "solver.model=" + model, "contact.size=body"});
    const double truth = found(of_mesh, "peak_force_N");
    const double before = std::abs(found(half_space, "peak_force_N") / truth - 1.0);
    const double after = std::abs(found(body, "peak_force_N") / truth - 1.0);
    EXPECT_GT(before, 0.03) << model;
    EXPECT_LT(after, 0.3 * before) << model;
    EXPECT_LE(after, found(body, "stated_error")) << model;
    EXPECT_LT(found(body, "stated_error"), found(half_space, "stated_error")) << model;
    EXPECT_LT(found(body, "pressure_map_imbalance"), 1e-3) << model;
    // Every row has the factor of its own depth.
    const scene::Choice choice = chosen(pressed(tissue));
    const scenario::Model named =
        model == "layer" ? scenario::Model::layer : scenario::Model::hertz;
    const auto ratio = scene::size_ratio(named, choice.chosen, choice.touch, choice.expected);
    ASSERT_TRUE(ratio.has_value());
    ASSERT_EQ(body.contact.size(), half_space.contact.size());
    for (std::size_t i = 0; i < body.contact.size(); ++i)
      EXPECT_NEAR(
          body.contact[i].contact_force,
          ratio->value(half_space.contact[i].indentation) * half_space.contact[i].contact_force,
          1e-12);
  }
}

TEST(SizeRatio, IsTakenWhereNoMeshIsNeededWithIt) {
  for (const std::string& tissue : {narrow, ball}) {
    const scene::Choice choice = chosen(pressed(tissue));
    EXPECT_TRUE(choice.found.size_matters);
    EXPECT_FALSE(scenario::rung(choice.chosen.solver.model).meshed());
    EXPECT_EQ(choice.chosen.contact.size, scenario::Contact::Size::body);
    EXPECT_LE(choice.taken()->error, choice.chosen.solver.tolerance);
    const scene::Choice without = chosen(pressed(tissue, "", "size = \"half_space\"\n"));
    EXPECT_TRUE(scenario::rung(without.chosen.solver.model).meshed());
  }
  // Nor is it taken where the formula is enough without.
  const scene::Choice wide = chosen(
      pressed("shape = { kind = \"cuboid\", size = [\"200 mm\", \"200 mm\", \"30 mm\"] }\n"));
  EXPECT_EQ(wide.chosen.solver.model, scenario::Model::layer);
  EXPECT_FALSE(wide.found.size_matters);
}

TEST(SizeRatio, IsRefusedWhereItIsNotKnown) {
  const auto said = [](const std::string& text) {
    return refusal([&] { return run_text(text, {"contact.size=body"}); });
  };
  const std::string known =
      "`body` is known for `hertz` on a curved body and for `layer` on a cuboid, under a finger "
      "that does not move sideways, where it changes the force by at most 50 %; write `size = "
      "\"half_space\"`, or set `solver.model = \"coupled_springs\"`";
  EXPECT_NE(said(pressed(narrow, "[solver]\nmodel = \"hertz\"\n")).find(known), std::string::npos);
  EXPECT_NE(said(pressed(narrow,
                         "[[step]]\nkind = \"slide\"\nby = \"3 mm\"\nrate = \"5 mm/s\"\n"
                         "[solver]\nmodel = \"layer\"\n"))
                .find(known),
            std::string::npos);
  EXPECT_EQ(said(pressed(narrow, "[solver]\nmodel = \"layer\"\n")), "accepted");
}

}  // namespace
}  // namespace palpate::test
