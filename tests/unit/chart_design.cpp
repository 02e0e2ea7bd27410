// Which variants a chart measures, and what it refuses.
#include "chart/design.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "run/choose.h"
#include "scenario/words.h"
#include "scenario_text.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "scene_text.h"

namespace palpate::chart {
namespace {

std::vector<Variant> design(const Asked& asked, std::size_t of_case) {
  scene::SpecimenShapes shapes;
  return design(asked, of_case, shapes);
}

struct ScratchFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate-design-" + std::to_string(::getpid()));
  ScratchFolder() { std::filesystem::create_directories(path); }
  ~ScratchFolder() { std::filesystem::remove_all(path); }
};

class Design : public testing::Test {
 protected:
  Asked asked(const std::string& text, const std::vector<std::string>& settings = {}) const {
    const std::string path = (folder_.path / "scene.toml").string();
    std::ofstream(path) << text;
    return read_for_chart(path, settings);
  }
  std::string refusal(const std::string& text) const {
    try {
      (void)asked(text);
      return "accepted";
    } catch (const InputError& error) {
      return error.problems().front().message;
    }
  }
  ScratchFolder folder_;
};

const Variant* find(const std::vector<Variant>& variants, const std::string& name) {
  const auto place = std::find_if(variants.begin(), variants.end(),
                                  [&](const Variant& one) { return one.name == name; });
  return place == variants.end() ? nullptr : &*place;
}

using Settings = std::vector<std::string>;

const std::string quick = scenario::press + "[contact]\ncoupling = \"one_way\"\n";

TEST_F(Design, APressHasEveryGroup) {
  const auto variants = design(asked(quick), 0);
  ASSERT_FALSE(variants.empty());
  EXPECT_EQ(variants.front().name, "auto");
  EXPECT_EQ(variants.front().settings,
            (Settings{"contact.coupling=consistent", "contact.viscosity=none"}))
      << "`one_way` keeps nearer models away";
  EXPECT_EQ(variants[1].name, "as it stands");
  std::set<std::string> names, groups;
  for (const Variant& one : variants) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    groups.insert(one.group);
  }
  EXPECT_EQ(groups, (std::set<std::string>{"base", "model x mesh", "model x coupling", "rings"}))
      << "integrators do not change this force";
  EXPECT_EQ(find(variants, "hertz"), nullptr) << "as it stands: not twice";
  EXPECT_EQ(find(variants, "layer"), nullptr) << "`auto` takes it: not twice";
  EXPECT_EQ(find(variants, "coupled_springs, nodes x 4")->settings,
            (Settings{"solver.model=coupled_springs", "contact.depth=neo_hookean",
                      "solver.integrator=quasi_static",
                      "tissue.mesh={kind='mirrored',cells=[5,6,10]}"}));  // 3 4 6 by 4^(1/3)
  EXPECT_EQ(find(variants, "mass_spring, 2 rings")->settings.back(), "solver.rings=2");
  EXPECT_NE(find(variants, "coupled_springs, resolved on graded cells"), nullptr);
}

// With a mesh whose inertia reaches the force.
const std::string moving = scenario::press + "[tissue]\nviscosity = \"none\"\n";

TEST_F(Design, EveryIntegratorTakesPart) {
  const auto variants = design(asked(moving), 0);
  for (const Word& word : scenario::words::integrators) {
    const std::string own = std::string("solver.integrator=") + word.word;
    const auto count = std::count_if(variants.begin(), variants.end(), [&](const Variant& one) {
      return one.group == "integrator x time step" &&
             std::find(one.settings.begin(), one.settings.end(), own) != one.settings.end();
    });
    // Its own step may be one of the three, and may be there as a model already.
    EXPECT_GE(count, 2) << word.word;
  }
  EXPECT_EQ(find(variants, "mass_spring, auto"), nullptr);
}

TEST_F(Design, ExplicitMethodsAlsoAtHalfTheirLimit) {
  const Asked scene = asked(moving);
  const auto variants = design(scene, 0);
  const Variant* half = find(variants, "mass_spring, central_difference, half the limit");
  ASSERT_NE(half, nullptr);
  const auto family = with_settings(scene, 0, half->settings);
  const auto plan = test::first_scene(family).specimen->plan;
  EXPECT_LE(plan.substep, 0.5 * plan.limit.value());
  EXPECT_GT(plan.time_step / (plan.substeps - 1), 0.5 * plan.limit.value());
  EXPECT_EQ(find(variants, "mass_spring, backward_difference, half the limit"), nullptr);
  EXPECT_EQ(find(variants, "mass_spring, modal, half the limit"), nullptr);
}

TEST_F(Design, EveryVariantIsReadOrRefusedWithASentence) {
  const Asked scene = asked(quick);
  for (const Variant& one : design(scene, 0)) {
    try {
      const auto family = with_settings(scene, 0, one.settings);
      EXPECT_EQ(family.cases.size(), 1U);
    } catch (const InputError& error) {
      ADD_FAILURE() << one.name << ": " << error.what();  // a press of a cuboid takes them all
    }
  }
}

TEST_F(Design, RowsOfLongStepsLieOnThoseOfTheScenario) {
  const auto variants = design(asked(scenario::creep + "[output]\ninterval = \"10 ms\"\n"), 0);
  const Variant* slow = find(variants, "mass_spring, quasi_static, 4 ms");
  ASSERT_NE(slow, nullptr);
  EXPECT_EQ(slow->settings.back(), "output.interval=20 ms");
  EXPECT_NE(find(variants, "mass_spring, quasi_static, 0.25 ms")->settings.back().find("substeps"),
            std::string::npos);
  scenario::Scenario coarse;
  coarse.output.interval = 0.010;
  EXPECT_DOUBLE_EQ(coarsest_interval(coarse), 0.020);
  coarse.output.interval = 0.001;
  EXPECT_DOUBLE_EQ(coarsest_interval(coarse), 0.004);
}

TEST_F(Design, AUniformTestHasNoContact) {
  for (const Variant& one : design(asked(scenario::creep), 0)) {
    EXPECT_NE(one.group, "rings");
    EXPECT_NE(one.group, "model x coupling");
  }
}

TEST_F(Design, AGivenModelIsAVariantBesideAuto) {
  const auto variants = design(asked(quick + "[solver]\nmodel = \"layer\"\n"), 0);
  EXPECT_EQ(variants[0].settings.front(), "solver.model=auto");
  EXPECT_EQ(find(variants, "layer"), nullptr) << "`auto` takes it, and so does the scenario";
}

TEST_F(Design, AutoIsFreeInWhatTheScenarioNames) {
  const Asked scene = asked(
      "[tissue]\nshape = { kind = \"ellipsoid\" }\nmesh = { kind = \"tetgen\", nodes = 200 }\n"
      "[contact]\ncoupling = \"series\"\n[solver]\nmodel = \"mass_spring\"\nintegrator = "
      "\"modal\"\ntime_step = \"1 ms\"\nrings = 3\n" +
      scenario::press);
  const auto variants = design(scene, 0);
  EXPECT_EQ(variants[0].settings,
            (Settings{"solver.model=auto", "solver.integrator=auto", "solver.time_step=auto",
                      "solver.rings=all", "tissue.mesh={kind='tetgen',refine=true}",
                      "contact.coupling=consistent", "contact.viscosity=none"}));
  EXPECT_EQ(variants[1].name, "as it stands");
  const auto family = with_settings(scene, 0, variants[0].settings);
  scenario::Scenario neglected = family.cases.front().scenario;
  EXPECT_TRUE(scenario::refinement(neglected.tissue.mesh).refine);
  EXPECT_FALSE(neglected.solver.model || neglected.solver.integrator ||
               neglected.solver.time_step || neglected.solver.rings);
}

// Large strains raise the force by 2 %: `auto` and a named layer include them, so that the scenario
// as it stands is the point `auto`; another named model has to be told to.
TEST_F(Design, VariantsOfADeepPressSayThatItIs) {
  using Depth = scenario::Contact::Depth;
  const std::string deep =
      "[solver]\nmodel = \"layer\"\n[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n";
  const Asked press = asked(deep);
  EXPECT_EQ(press.depths, std::vector<Depth>{Depth::neo_hookean});
  const auto variants = design(press, 0);
  EXPECT_EQ(find(variants, "hertz")->settings,
            (Settings{"solver.model=hertz", "contact.depth=neo_hookean"}));
  EXPECT_EQ(find(variants, "auto")->settings, Settings{"solver.model=auto"});
  EXPECT_EQ(find(variants, "as it stands"), nullptr);
  const auto depth_of = [&](const char* name) {
    const auto family = with_settings(press, 0, find(variants, name)->settings);
    return run::choose(family.cases.front()).chosen.contact.depth;
  };
  for (const char* name : {"auto", "hertz", "coupled_springs"})
    EXPECT_EQ(depth_of(name), Depth::neo_hookean) << name;
  EXPECT_EQ(depth_of("coupled_springs, series"), Depth::hertz);
  const auto given = design(asked(deep + "[contact]\ndepth = \"hertz\"\n"), 0);
  EXPECT_EQ(find(given, "hertz")->settings, Settings{"solver.model=hertz"});
}

TEST_F(Design, TetgenMeshesScaleByNodes) {
  const auto variants = design(
      asked(quick + "[tissue]\nshape = { kind = \"ellipsoid\" }\nmesh = { kind = \"tetgen\", nodes "
                    "= 200, tetrahedra = 600 }\n"),
      0);
  EXPECT_EQ(find(variants, "mass_spring, nodes x 0.25")->settings.back(),
            "tissue.mesh={kind='tetgen',nodes=50}");
  EXPECT_EQ(find(variants, "mass_spring, resolved on graded cells"), nullptr);
}

TEST_F(Design, ACaseOfASweepIsSettledAlone) {
  const Asked scene = asked(scenario::press +
                            "[sweep]\n\"tissue.material\" = [\"skin\", \"muscle\"]\n"
                            "\"finger.radius\" = [\"11 mm\", \"8 mm\"]\n");
  ASSERT_EQ(scene.family.cases.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto family = with_settings(scene, i, {"solver.model=hertz"});
    ASSERT_EQ(family.cases.size(), 1U);
    const auto& got = family.cases.front();
    const auto& want = scene.family.cases[i];
    EXPECT_EQ(got.name, want.name);
    EXPECT_EQ(got.scenario.tissue.material, want.scenario.tissue.material);
    EXPECT_EQ(got.scenario.finger.radius, want.scenario.finger.radius);
    EXPECT_EQ(got.scenario.solver.model, scenario::Solver::Model::hertz);
  }
}

TEST_F(Design, SettingsOfTheCommandLineStay) {
  const Asked scene = asked(scenario::press, {"tissue.young_modulus=5 kPa"});
  EXPECT_EQ(*with_settings(scene, 0, {"solver.model=layer"}).cases[0].scenario.tissue.young_modulus,
            5000.0);
}

TEST_F(Design, Refusals) {
  EXPECT_EQ(refusal(scenario::press +
                    "[sweep]\n\"finger.radius\" = [\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 "
                    "mm\", \"6 mm\", \"7 mm\", \"8 mm\", \"9 mm\"]\n"
                    "[solver]\nmodel = \"hertz\"\n[tissue]\nshape = { kind = \"half_space\" }\n")
                .substr(0, 60),
            "`to` of 2 mm is deeper than the finger's radius of 1 mm, and");
  EXPECT_EQ(refusal("[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n[sweep]\n\"finger.radius\" = "
                    "[\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 mm\", \"6 mm\", \"7 mm\", \"8 "
                    "mm\", \"9 mm\"]\n"),
            "`palpate chart` measures up to 8 cases, and `sweep` makes 9; give shorter lists");
  EXPECT_EQ(refusal(scenario::press + "[sweep]\n\"solver.rings\" = [2, 3]\n"),
            "`solver.rings` is swept, and `palpate chart` varies `solver.rings` itself; set it to "
            "one value, with `[sweep]` without it");
  EXPECT_EQ(refusal("[[step]]\nkind = \"indent\"\nto = \"1 N\"\n"),
            "a step to a force ends elsewhere in every configuration, and `palpate chart` compares "
            "forces at equal displacements; give a displacement");
}

}  // namespace
}  // namespace palpate::chart
