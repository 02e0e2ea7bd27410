// The keys of the table of models: what is read, completed and refused.
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

std::string reread(const std::string& text) {
  const std::string written = echo(parse(text, "press.toml", {}));
  EXPECT_EQ(echo(parse(written, "press.toml", {})), written) << text;
  return written;
}

TEST(ModelKeys, TheContactKnowsViscosityThatTheScenarioGives) {
  using Viscosity = Contact::Viscosity;
  EXPECT_EQ(read_one(press).contact.viscosity, Viscosity::none);
  const std::string given = press + "[tissue]\nviscosity = \"kelvin_voigt\"\n";
  EXPECT_EQ(read_one(given).contact.viscosity, Viscosity::tissue);
  EXPECT_EQ(read_one(given + "[contact]\ncoupling = \"one_way\"\n").contact.viscosity,
            Viscosity::none);
  EXPECT_EQ(read_one(given + "[contact]\nviscosity = \"none\"\n").contact.viscosity,
            Viscosity::none);
  EXPECT_EQ(read_one(press + "[tissue]\nviscosity = \"none\"\n").contact.viscosity,
            Viscosity::none);
  // The echo says what was found, so that a default which it spells out changes nothing.
  EXPECT_NE(reread(press).find("viscosity = \"none\""), std::string::npos);
  EXPECT_NE(reread(given).find("viscosity = \"tissue\""), std::string::npos);
}

TEST(ModelKeys, PronyBranchesAreReadAndEchoed) {
  const std::string text = press +
                           "[tissue]\nviscosity = \"prony\"\n"
                           "[[tissue.branch]]\nrelaxation_time = \"4 ms\"\nratio = 0.5\n"
                           "[[tissue.branch]]\nrelaxation_time = \"1.4 s\"\nratio = 2\n";
  const Scenario scenario = read_one(text);
  ASSERT_EQ(scenario.tissue.branches.size(), 2U);
  EXPECT_EQ(scenario.tissue.branches[0].relaxation_time, 0.004);
  EXPECT_EQ(scenario.tissue.branches[1].ratio, 2.0);
  EXPECT_EQ(scenario.contact.viscosity, Contact::Viscosity::tissue);
  const Scenario again = read_one(reread(text));
  ASSERT_EQ(again.tissue.branches.size(), 2U);
  EXPECT_EQ(again.tissue.branches[1].relaxation_time, 1.4);
}

TEST(ModelKeys, ARegionsPoissonRatioReachesModelsThatHonourIt) {
  const std::string region =
      "[tissue]\nmesh = { kind = \"tetgen\" }\n[[region]]\nkind = \"sphere\"\nmaterial = "
      "\"muscle\"\npoisson_ratio = 0.45\n";
  const Scenario coupled = read_one(press + "[solver]\nmodel = \"coupled_springs\"\n" + region);
  EXPECT_EQ(coupled.regions[0].poisson_ratio, 0.45);
  EXPECT_EQ(read_one(press + "[tissue]\nmesh = { kind = \"tetgen\" }\n[[region]]\nkind = "
                             "\"sphere\"\nmaterial = \"muscle\"\n")
                .regions[0]
                .poisson_ratio,
            0.4);  // the material's
}

TEST(ModelKeys, RefusalsNameTheKeyAndARemedy) {
  expect_refused({
      {"[tissue]\nviscosity = \"prony\"\n",
       "press.toml:5:13: `prony` needs branches; add a `[[tissue.branch]]` with "
       "`relaxation_time` and `ratio`"},
      {"[[tissue.branch]]\nratio = 1\n",
       "press.toml:4:10: `branch` has no effect here: it is used only with `viscosity = "
       "\"prony\"`; remove it or change that"},
      {"[contact]\nviscosity = \"tissue\"\n[tissue]\nviscosity = \"none\"\n",
       "press.toml:5:13: a contact can include the viscosity of a material only, and "
       "`tissue.viscosity` is "
       "`none`; set it to `kelvin_voigt`, `standard_linear_solid` or `prony`"},
      {"[contact]\nviscosity = \"tissue\"\ncoupling = \"series\"\n[solver]\nmodel = "
       "\"mass_spring\"\n",
       "press.toml:5:13: with this `coupling` the mesh carries the tissue's viscosity to the "
       "contact already; write `viscosity = \"none\"`"},
      {"[contact]\ndepth = \"neo_hookean\"\ncoupling = \"resolved\"\n",
       "press.toml:5:9: with this `coupling` the mesh is the tissue, and the factor is that of a "
       "contact law; write `coupling = \"consistent\"`, or `depth = \"hertz\"`"},
      {"[solver]\nmodel = \"neo_hookean\"\n",
       "press.toml:5:9: `model` calls `neo_hookean` `solid` now; write `model = \"solid\"`"},
      {"[contact]\ncoupling = \"resolved\"\n[solver]\nmodel = \"solid\"\n",
       "press.toml:5:12: `solid` carries contact and tissue in one mesh; leave `coupling` out"},
      {"[solver]\nmodel = \"coupled_springs\"\nvolume = \"none\"\n",
       "press.toml:6:10: `coupled_springs` always resist a change of volume; set `solver.volume = "
       "\"nodal\"`, or `solver.model = \"mass_spring\"`"},
      {"[contact]\ncoupling = \"resolved\"\n[solver]\nmodel = \"coupled_springs\"\nintegrator = "
       "\"central_difference\"\n",
       "press.toml:8:14: `resolved` solves for forces and motion together, which an explicit "
       "method cannot do, and in `modal` steps they oscillate; set `integrator` to "
       "`quasi_static`, `backward_difference` or `tr_bdf2`"},
      {"[contact]\ncoupling = \"resolved\"\n[solver]\nmodel = \"coupled_springs\"\nintegrator = "
       "\"semi_implicit_euler\"\n",
       "press.toml:8:14: `resolved` solves for forces and motion together, which an explicit "
       "method cannot do, and in `modal` steps they oscillate; set `integrator` to "
       "`quasi_static`, `backward_difference` or `tr_bdf2`"},
      {"[contact]\nspread = \"nearest_node\"\n[solver]\nmodel = \"mass_spring\"\n",
       "press.toml:5:10: `nearest_node` is for `one_way` and `series`; write `spread = "
       "\"pressure\"`"},
      {"[solver]\nmodel = \"mass_spring\"\n[[region]]\ntag = 1\npoisson_ratio = 0.4\n",
       "press.toml:8:17: independent springs have a Poisson's ratio of their own; set "
       "`solver.volume = \"nodal\"` or `solver.model = \"coupled_springs\"`, or leave it out"},
      {"[[step]]\nkind = \"slide\"\nby = \"1 mm\"\nkeep = \"force\"\n[tissue]\nviscosity = "
       "\"kelvin_voigt\"\n",
       "press.toml:7:8: a slide cannot keep a force that relaxes; write `keep = \"displacement\"`, "
       "or "
       "`contact.viscosity = \"none\"`"},
  });
  expect_refused({{"[solver]\nmodel = \"layer\"\n",
                   "press.toml:5:9: `layer` has no specimen between platens; set `solver.model = "
                   "\"mass_spring\"` or `\"coupled_springs\"`"}},
                 creep);
}

}  // namespace
}  // namespace palpate::scenario
