// Sweeps, settings, materials and meshes from files: what a family is made of.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "scenario/resolved.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> case_names(const Family& family) {
  std::vector<std::string> names;
  for (const Case& one : family.cases) names.push_back(one.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(Sweep, RunsEveryValueWithEveryOther) {
  const Family family = parse(press +
                                  "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n"
                                  "\"contact.friction\" = [0.0, 0.3, 1]\n",
                              "press.toml", {});
  EXPECT_EQ(case_names(family),
            (Names{"skin_0.0", "skin_0.3", "skin_1", "bone_0.0", "bone_0.3", "bone_1"}));
  EXPECT_EQ(filled(family.cases[4]).tissue.young_modulus, 1.7e10);
  EXPECT_EQ(family.cases[4].scenario.contact.friction, 0.3);
  EXPECT_EQ(family.cases[4].swept[1],
            (std::pair<std::string, std::string>{"contact.friction", "0.3"}));
}

TEST(Sweep, KeysMayStandWithoutQuotes) {
  EXPECT_EQ(
      case_names(parse(press + "[sweep]\ntissue.material = [\"skin\", \"bone\"]\n", "p.toml", {})),
      (Names{"skin", "bone"}));
}

TEST(Sweep, ReachesStepsAndWholeTables) {
  const Family family =
      parse(press +
                "[sweep]\n\"step.1.to\" = [\"1 mm\", \"3 mm\"]\n\"tissue.mesh\" = [{ kind = "
                "\"kuhn\" }, { kind = \"tetgen\", nodes = 100 }]\n",
            "press.toml", {});
  EXPECT_EQ(case_names(family), (Names{"1 mm_mesh1", "1 mm_mesh2", "3 mm_mesh1", "3 mm_mesh2"}));
  EXPECT_EQ(std::get<Indent>(family.cases[2].scenario.steps[0]).to.value, 0.003);
  EXPECT_EQ(std::get<Tetgen>(family.cases[1].scenario.tissue.mesh).nodes, 100);
}

TEST(Sweep, MistakesAreToldOnceAndAtTheirValue) {
  const std::pair<const char*, const char*> cases[] = {
      {"\"tissue.young_modulos\" = [\"1 kPa\", \"2 kPa\", \"3 kPa\"]\n",
       "press.toml:5:1: `young_modulos` is not a key here; did you mean `young_modulus`?"},
      {"\"tissue.material\" = []\n",
       "press.toml:5:21: `tissue.material` wants a list of values to run, got an empty one; write "
       "`\"tissue.material\" = [\"...\", \"...\"]`, or a range, `{ from = ..., to = ... }`"},
      {"\"tissue.material\" = \"skin\"\n",
       "press.toml:5:21: `tissue.material` wants a list of values to run, got a text; write "
       "`\"tissue.material\" = [\"...\", \"...\"]`, or a range, `{ from = ..., to = ... }`"},
      {"\"tissue.material\" = [\"skin\", \"musle\", \"bone\"]\n",
       "press.toml:5:30: `material` does not know `musle`; did you mean `muscle`? Known here: "
       "finger, skin, muscle, bone, ligament, upper_leg; your own tables are written "
       "`file.toml#name`"},
      {"\"tissue.young_modulus\" = [\"1 kPa\", \"2 mm\"]\n\"contact.friction\" = [0, 1]\n",
       "press.toml:5:36: `young_modulus` wants a pressure, got `2 mm`, a length; write it as `2 "
       "kPa`"},
      {"\"tissue.material\" = [\"skin\", \"skin\"]\n",
       "press.toml:5:30: `skin` and `skin` of `tissue.material` make the same case; keep one of "
       "them"},
      {"design = \"latin\"\n\"tissue.material\" = [\"skin\"]\n",
       "press.toml:5:10: `design` does not know `latin`; it is one of grid, lhs, sobol, saltelli, "
       "list, csv"},
      {"tissue.material = [\"skin\"]\n\"tissue.material\" = [\"bone\"]\n",
       "press.toml:6:1: `tissue.material` is swept twice; keep one of the two"},
      {"\"step.2.to\" = [\"1 mm\"]\n",
       "press.toml:5:1: `step.2.to` cannot be set: `2` is none of the list's entries; count them "
       "from 1 to 1, or append one by `2.kind`"},
  };
  for (const auto& [text, sentence] : cases)
    EXPECT_EQ(refusal(press + "[sweep]\n" + text), sentence) << text;
  EXPECT_EQ(
      refusal("sweep = 3\n" + press),
      "press.toml:1:9: `sweep` wants a table of keys and lists, got an integer; write `[sweep]`");
  // A mistake of the scenario itself is the same in every case.
  EXPECT_EQ(refusal(press + "rat = 1\n[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n"),
            "press.toml:4:1: `rat` is not a key here; did you mean `rate`?");
}

TEST(Sweep, TooManyCasesAreRefusedBeforeTheyAreMade) {
  std::string text = press + "[sweep]\n";
  for (int i = 0; i < 64; ++i)  // 2^64 cases: their number alone would overflow to 0
    text += "\"a" + std::to_string(i) + "\" = [1, 2]\n";
  EXPECT_EQ(refusal(text),
            "press.toml:4:1: `sweep` makes 1.845e+19 cases, and 1e+09 is the most; give shorter "
            "lists or several scenarios");
  std::string list = "[1";
  for (int i = 2; i <= 1001; ++i) list += ", " + std::to_string(i);
  EXPECT_EQ(refusal(press + "[sweep]\n\"finger.spheres\" = " + list + "]\n"),
            "press.toml:4:1: `sweep` makes 1001 cases, and more than 1000 are planned first: "
            "`palpate sweep plan press.toml`");
}

TEST(Sweep, DisplayScalesNameCases) {
  EXPECT_EQ(refusal(press + "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n[output]\n"
                            "display_scale = { bnoe = 0.1 }\n"),
            "press.toml:7:26: `display_scale` names no case `bnoe`; did you mean `bone`?");
}

TEST(Setting, GoesThroughTheSameChecks) {
  const auto said = [](const std::string& setting) { return refusal(press, {setting}); };
  EXPECT_EQ(said("tissue.young_modulus=60 kPa"), "accepted");
  EXPECT_EQ(said("tissue.young_modulus=\"60 kPa\""), "accepted");
  EXPECT_EQ(said("tissue.mesh.kind=kuhn"), "accepted");
  EXPECT_EQ(said("step.1.to=1 N"), "accepted");
  EXPECT_EQ(said("tissue.young_modulos=1 kPa"),
            "--set tissue.young_modulos=1 kPa: `young_modulos` is not a key here; did you mean "
            "`young_modulus`?");
  EXPECT_EQ(said("tisue.material=skin"),
            "--set tisue.material=skin: `tisue` is not a key here; did you mean `tissue`?");
  EXPECT_EQ(
      said("tissue.mesh.kind=kun"),
      "--set tissue.mesh.kind=kun: `kind` does not know `kun`; did you mean `kuhn`? It is one of "
      "kuhn, mirrored, tetgen, file");
  EXPECT_EQ(
      said("step.1.to=3 kPa"),
      "--set step.1.to=3 kPa: `to` wants a length or a force, got `3 kPa`, a pressure; write it "
      "as `3 mm`");
  EXPECT_EQ(
      said("tissue.young_modulus=60"),
      "--set tissue.young_modulus=60: `young_modulus` wants a pressure with its unit, as text, "
      "got an integer `60`; write it as `young_modulus = \"60 kPa\"`");
  EXPECT_EQ(
      said("contact.friction=1e400"),
      "--set contact.friction=1e400: `friction` wants a finite number, got `1e400`; write one "
      "as `0.5`");
  EXPECT_EQ(
      refusal(press + "[tissue]\nyung = 1\n", {"finger.radius=0 mm", "contact.friction=-1"}),
      "press.toml:5:1: `yung` is not a key here; known keys: base, base_height, base_side, branch, "
      "density, "
      "drag, instantaneous_ratio, material, mesh, poisson_ratio, relaxation_time, "
      "retardation_time, "
      "shape, viscosity, young_modulus\n"
      "--set finger.radius=0 mm: `radius` must be at least 1e-06 mm and at most 1e+06 mm, got `0 "
      "mm`; give a value in that "
      "range\n"
      "--set contact.friction=-1: `friction` must be at least 0, got `-1`; give a value in that "
      "range");
}

TEST(Setting, OfASweptKeyIsItsList) {
  const std::string swept = press + "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n";
  EXPECT_EQ(refusal(swept, {"tissue.material=muscle"}),
            "--set tissue.material=muscle: `tissue.material` is swept, so that one value has no "
            "effect; set the list, `sweep.tissue.material=[...]`");
  EXPECT_EQ(case_names(parse(swept, "p.toml", {"sweep.tissue.material=[\"muscle\"]"})),
            Names{"muscle"});
}

// --- files

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("palpate_families_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "tables");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    write_atomically((folder_ / name).string(), text);
  }
  [[nodiscard]] std::string scenario() const { return (folder_ / "press.toml").string(); }

  // The message with the folder's name taken out.
  [[nodiscard]] std::string said(const std::string& text) const {
    std::string message = refusal(press + text, {}, scenario());
    const std::string name = folder_.string() + "/";
    for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
      message.erase(at, name.size());
    return message;
  }

  fs::path folder_;
};

const char* const gel_table =
    "[gel]\n"
    "density       = { value = \"1000 kg/m^3\", source = \"scale\" }\n"
    "young_modulus = { value = \"12.3 kPa\", source = \"press\" }\n"
    "poisson_ratio = { value = 0.45, source = \"assumed: gel\" }\n";

TEST_F(Files, TablesOfTheUserWorkWhereOursDo) {
  write("tables/my.toml", gel_table);
  const Family family = parse(press +
                                  "[tissue]\nmaterial = \"tables/my.toml#gel\"\nviscosity = "
                                  "\"none\"\n[finger]\nmaterial = \"tables/my.toml#gel\"\n",
                              scenario(), {});
  EXPECT_EQ(filled(family.cases[0]).tissue.young_modulus, 12300.0);
  EXPECT_EQ(filled(family.cases[0]).finger.poisson_ratio, 0.45);
  ASSERT_EQ(family.inputs.size(), 2U);
  EXPECT_EQ(family.inputs[1].name, "my.toml");
  EXPECT_EQ(family.inputs[1].content, gel_table);
}

TEST_F(Files, TablesThatCannotBeUsed) {
  write("my.toml", gel_table);
  write("bad.toml",
        "[gel]\ndensitty = { value = \"1 kg/m^3\" }\nyoung_modulus = { value = \"0 kPa\" }\n");
  write("empty.toml", "a = 1\n");
  write("rubbish.toml", "\x01\x02");
  EXPECT_EQ(said("[tissue]\nmaterial = \"no.toml#gel\"\n"),
            "press.toml:5:12: `material` names `no.toml`, which cannot be read: No such file or "
            "directory; check the path");
  EXPECT_EQ(
      said("[tissue]\nmaterial = \"my.toml#gell\"\n"),
      "press.toml:5:12: `material` does not know `gell`; did you mean `gel`? Known here: gel; "
      "your own tables are written `file.toml#name`");
  EXPECT_EQ(
      said("[tissue]\nmaterial = \"empty.toml#gel\"\n"),
      "press.toml:5:12: `material` does not know `gel`; known here: none; your own tables are "
      "written `file.toml#name`");
  EXPECT_EQ(said("[tissue]\nmaterial = \"my.toml#gel\"\nviscosity = \"kelvin_voigt\"\n"),
            "press.toml:5:12: `my.toml#gel` has no `retardation_time`; give "
            "`tissue.retardation_time`, or write `tissue.viscosity = \"none\"`");
  EXPECT_EQ(said("[tissue]\nmaterial = \"bad.toml#gel\"\n"),
            "bad.toml:1:2: `gel` lacks `poisson_ratio`; add `poisson_ratio = ...`, or `{ value = "
            "..., source = \"...\" }`\n"
            "bad.toml:2:1: `densitty` is not a key here; did you mean `density`?\n"
            "bad.toml:3:27: `value` must be above 0 kPa, got `0 kPa`; give a value in that range");
  EXPECT_EQ(said("[tissue]\nmaterial = \"rubbish.toml#gel\"\n"),
            "rubbish.toml:1:1: this is not a text file; give a TOML file");
  EXPECT_EQ(said("[tissue]\nmaterial = \"finger\"\n"),
            "press.toml:5:12: `finger` has a Poisson's ratio of 0.5, and a tissue needs less; set "
            "`tissue.poisson_ratio = 0.49`");
}

TEST_F(Files, AMaterialWithoutViscosityIsElasticUnlessViscosityIsAskedFor) {
  write("my.toml", gel_table);
  const std::string gel = "[tissue]\nmaterial = \"my.toml#gel\"\n";
  const auto law = [&](const std::string& keys) {
    return parse(keys, scenario(), {}).cases[0].scenario.tissue.viscosity;
  };
  EXPECT_EQ(law(press + gel), tissue::Viscosity::none);
  EXPECT_EQ(law(press + gel + "[solver]\nmodel = \"coupled_springs\"\n"), tissue::Viscosity::none);
  EXPECT_EQ(law(press + gel + "retardation_time = \"1 s\"\n"), tissue::Viscosity::kelvin_voigt);
  EXPECT_EQ(law(press), tissue::Viscosity::kelvin_voigt) << "skin has a retardation time";
  const std::string lacks =
      "`my.toml#gel` has no `retardation_time`; give "
      "`tissue.retardation_time`, or write `tissue.viscosity = \"none\"`";
  EXPECT_EQ(said(gel + "[contact]\nviscosity = \"tissue\"\n"),
            "press.toml:5:12: `my.toml#gel` has no `retardation_time`; give "
            "`tissue.retardation_time`, or write `contact.viscosity = \"none\"`");
  try {
    (void)parse("schema = 1\n" + gel + "[[step]]\nkind = \"creep\"\n", scenario(), {});
    ADD_FAILURE() << "creep without a law of time";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(lacks), std::string::npos) << error.what();
  }
}

TEST_F(Files, ATableNeedsThreeNumbers) {
  write("my.toml",
        "[gel]\ndensity = \"1020 kg/m^3\"\nyoung_modulus = \"12 kPa\"\n"
        "poisson_ratio = 0.45\n[block]\ndensity = 1020\n"
        "young_modulus = { value = \"12 kPa\" }\npoisson_ratio = 0.5\n");
  EXPECT_EQ(said("[tissue]\nmaterial = \"my.toml#gel\"\n[solver]\nmodel = \"hertz\"\n"),
            "accepted");
  EXPECT_EQ(said("[tissue]\nmaterial = \"my.toml#block\"\n"),
            "my.toml:6:11: `value` wants a density with its unit, as text, got an integer `1020`; "
            "write it as `value = \"1020 kg/m^3\"`");
}

TEST_F(Files, CopiesBesideTheEchoMustNotClash) {
  write("t.toml", gel_table);
  write("tables/t.toml", std::string(gel_table) + "# another\n");
  write("tables/scenario.toml", gel_table);
  EXPECT_EQ(said("[tissue]\nviscosity = \"none\"\nmaterial = \"t.toml#gel\"\n[finger]\nmaterial = "
                 "\"tables/t.toml#gel\"\n"),
            "press.toml:8:12: two different files are called `t.toml`, and a result folder holds a "
            "copy of each; rename one");
  EXPECT_EQ(
      said("[finger]\nmaterial = \"tables/scenario.toml#gel\"\n"),
      "press.toml:5:12: `scenario.toml` is the name of the echo among the results; rename the "
      "file");
}

TEST_F(Files, MeshesNeedTheirFileAndUnit) {
  write("box.node", "1");
  EXPECT_EQ(said("[tissue]\nmesh = { file = \"box.node\" }\n"),
            "press.toml:5:8: `mesh` lacks the unit of its coordinates; write `unit = \"mm\"`");
  EXPECT_EQ(said("[tissue]\nmesh = { file = \"box.node\", unit = \"kPa\" }\n"),
            "press.toml:5:36: `unit` wants a unit of length, got `kPa`; write `unit = \"mm\"`");
  EXPECT_EQ(said("[tissue]\nmesh = { kind = \"file\", unit = \"mm\" }\n"),
            "press.toml:5:8: `mesh` of kind `file` lacks `file`; write `file = \"box.node\"`");
  EXPECT_EQ(said("[tissue]\nmesh = { file = \"box.node\", unit = \"mm\" }\n"),
            "press.toml:5:17: `file` names `box.ele`, which cannot be read: No such file or "
            "directory; check the path");
  write("box.ele", "2");
  EXPECT_EQ(said("[tissue]\nmesh = { file = \"box.node\", unit = \"mm\" }\n"), "accepted");
}

}  // namespace
}  // namespace palpate::scenario
