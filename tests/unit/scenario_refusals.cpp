// Every way a scenario can be wrong, with the sentence and the place that it deserves.
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

TEST(Refusals, ThePlainScenarioIsAccepted) { EXPECT_EQ(refusal(press), "accepted"); }

TEST(Refusals, UnknownKeys) {
  const std::string tissue_keys =
      "base, base_height, base_side, branch, density, drag, instantaneous_ratio, material, mesh, "
      "poisson_ratio, "
      "relaxation_time, retardation_time, shape, viscosity, young_modulus";
  EXPECT_EQ(refusal("shema = 1\n" + press),
            "press.toml:1:1: `shema` is not a key here; did you mean `schema`?");
  expect_refused({
      {"[tisue]\nmaterial = \"skin\"\n",
       "press.toml:4:2: `tisue` is not a key here; did you mean `tissue`?"},
      {"[tissue]\n  young_modulos = \"60 kPa\"\n",
       "press.toml:5:3: `young_modulos` is not a key here; did you mean `young_modulus`?"},
      {"[tissue]\ncolour = \"red\"\n",
       "press.toml:5:1: `colour` is not a key here; known keys: " + tissue_keys},
      {"[tissue]\nmesh = { kind = \"kuhn\", cels = [1, 2, 3] }\n",
       "press.toml:5:25: `cels` is not a key here; did you mean `cells`?"},
      {"[tissue]\nmesh = { kind = \"tetgen\", cells = [1, 2, 3] }\n",
       "press.toml:5:27: `cells` is not a key here; known keys: edge, kind, "
       "most_nodes, nodes, refine, tetrahedra"},
      {"rat = \"5 mm/s\"\n", "press.toml:4:1: `rat` is not a key here; did you mean `rate`?"},
      {"[[step]]\nkind = \"hold\"\nrate = \"5 mm/s\"\n",
       "press.toml:6:1: `rate` is not a key here; known keys: kind, time"},
  });
}

TEST(Refusals, UnknownWords) {
  expect_refused({
      {"[solver]\nmodel = \"hertzz\"\n",
       "press.toml:5:9: `model` does not know `hertzz`; did you mean `hertz`? It is one of auto, "
       "hertz, layer, mass_spring, coupled_springs, solid"},
      {"[solver]\nmodel = \"granite\"\n",
       "press.toml:5:9: `model` does not know `granite`; it is one of auto, hertz, layer, "
       "mass_spring, coupled_springs, solid"},
      {"[solver]\nmodel = 5\n",
       "press.toml:5:9: `model` wants one of auto, hertz, layer, mass_spring, coupled_springs, "
       "solid, got "
       "an integer; write it as "
       "`model = \"auto\"`"},
      {"[tissue]\nmesh = { kind = \"kun\" }\n",
       "press.toml:5:17: `kind` does not know `kun`; did you mean `kuhn`? It is one of kuhn, "
       "mirrored, tetgen, file"},
      {"[[step]]\nkind = \"intend\"\nto = 5\n",
       "press.toml:5:8: `kind` does not know `intend`; did you mean `indent`? It is one of indent, "
       "hold, retract, slide, creep, relax, compress"},
      {"[solver]\ntime_step = \"autp\"\n",
       "press.toml:5:13: `time_step` wants `auto` or a time, got `autp`; write `auto`"},
      {"[solver]\nsubsteps = \"many\"\n",
       "press.toml:5:12: `substeps` wants `auto` or a whole number, got `many`; write `auto`"},
      {"[solver]\nrings = \"some\"\n",
       "press.toml:5:9: `rings` wants `all` or a whole number, got `some`; write `all`"},
  });
}

TEST(Refusals, KeysThatTheModelCannotHonour) {
  const std::string meshed =
      "it is used only with `solver.model = \"mass_spring\"` or `\"coupled_springs\"`; remove it "
      "or change that";
  expect_refused({
      {"[solver]\nmodel = \"hertz\"\n[tissue]\ndensity = \"1100 kg/m^3\"\n",
       "press.toml:7:1: `density` has no effect here: " + meshed},
      {"[solver]\nmodel = \"hertz\"\n[tissue]\nviscosity = \"none\"\ndrag = \"1 1/s\"\n",
       "press.toml:8:1: `drag` has no effect here: it is used only with `viscosity = "
       "\"nodal_drag\"`; remove it or change that"},
      {"[tissue]\ndrag = \"850 1/s\"\n",
       "press.toml:5:1: `drag` has no effect here: it is used only with `viscosity = "
       "\"nodal_drag\"`; remove it or change that"},
      {"[tissue]\nviscosity = \"standard_linear_solid\"\nretardation_time = \"1 s\"\n",
       "press.toml:6:1: `retardation_time` has no effect here: it is used only with `viscosity = "
       "\"kelvin_voigt\"`; remove it or change that"},
      {"[finger]\nmaterial = \"rigid\"\nyoung_modulus = \"1 MPa\"\n",
       "press.toml:6:1: `young_modulus` has no effect here: it is used only where the finger is "
       "not "
       "`rigid`; remove it or change that"},
      {"[finger]\ndensity = \"1 kg/m^3\"\n",
       "press.toml:5:1: `density` has no effect here: it is used only with `weight = \"apart\"`; "
       "remove it or change that"},
      {"[solver]\nintegrator = \"modal\"\nkinematics = \"nonlinear\"\n",
       "press.toml:6:14: `modal` solves linear bodies only; set `solver.kinematics = \"linear\"` "
       "or "
       "another integrator"},
      {"[solver]\nintegrator = \"quasi_static\"\n[tissue]\nviscosity = \"nodal_drag\"\n",
       "press.toml:5:14: `quasi_static` has no nodal drag; set `solver.integrator = "
       "\"backward_difference\"` or another viscosity"},
  });
  const std::string creep = "[[step]]\nkind = \"creep\"\n";
  EXPECT_EQ(refusal(creep + "[finger]\nradius = \"5 kPa\"\n[contact]\nfriction = -1\n"),
            "press.toml:3:2: `finger` has no effect here: it is used only by steps with a finger "
            "(indent, hold, retract, slide); remove it or change that\n"
            "press.toml:5:2: `contact` has no effect here: it is used only by steps with a finger "
            "(indent, hold, retract, slide); remove it or change that");
  EXPECT_EQ(refusal(creep + "[solver]\nmodel = \"hertz\"\n"),
            "press.toml:4:9: `hertz` has no specimen between platens; set `solver.model = "
            "\"mass_spring\"` or `\"coupled_springs\"`");
}

TEST(Refusals, MachineryOfAnotherModelIsLeftUnreadWithANote) {
  const Family family = parse(press +
                                  "[solver]\nmodel = \"hertz\"\nstart = \"paper\"\n"
                                  "time_step = \"0.7 ms\"\n[tissue]\nmesh = { kind = \"kuhn\" }\n",
                              "press.toml", {});
  std::string notes;
  for (const Problem& note : family.notes) notes += note.text() + "\n";
  const std::string unread =
      " is left unread: it is used only with `solver.model = \"mass_spring\"` or "
      "`\"coupled_springs\"`\n";
  EXPECT_EQ(notes, "press.toml:9:1: `mesh`" + unread + "press.toml:6:1: `start`" + unread +
                       "press.toml:7:1: `time_step`" + unread);
}

TEST(Refusals, DimensionsAndUnits) {
  expect_refused({
      {"rate = \"5 mm\"\n",
       "press.toml:4:8: `rate` wants a speed, got `5 mm`, a length; write it as `5 mm/s`"},
      {"[tissue]\nyoung_modulus = \"60\"\n",
       "press.toml:5:17: `young_modulus` wants a pressure with its unit, got `60`; write it as `60 "
       "kPa`"},
      {"[tissue]\nyoung_modulus = 60\n",
       "press.toml:5:17: `young_modulus` wants a pressure with its unit, as text, got an integer "
       "`60`; write it as `young_modulus = \"60 kPa\"`"},
      {"[tissue]\nyoung_modulus = 3000\n",
       "press.toml:5:17: `young_modulus` wants a pressure with its unit, as text, got an integer "
       "`3000`; write it as `young_modulus = \"3000 Pa\"`"},
      {"[tissue]\nyoung_modulus = \"3000\"\n",
       "press.toml:5:17: `young_modulus` wants a pressure with its unit, got `3000`; write it as "
       "`3000 Pa`"},
      {"[finger]\nradius = 0.011\n",
       "press.toml:5:10: `radius` wants a length with its unit, as text, got a number `0.011`; "
       "write it as `radius = \"0.011 m\"`"},
      {"[tissue]\nyoung_modulus = inf\n",
       "press.toml:5:17: `young_modulus` wants a pressure with its unit, as text, got a number "
       "`inf`; write it as `young_modulus = \"1 kPa\"`"},
      {"[tissue]\nyoung_modulus = \"60 kpa\"\n",
       "press.toml:5:17: `young_modulus` wants a pressure, got `60 kpa` with the unknown unit "
       "`kpa`; "
       "did you mean `60 kPa`?"},
      {"[[step]]\nkind = \"indent\"\nto = \"3 kPa\"\n",
       "press.toml:6:6: `to` wants a length or a force, got `3 kPa`, a pressure; write it as `3 "
       "mm`"},
      {"[tissue]\nshape = { size = [60, \"60 kPa\", \"30 mm\"] }\n",
       "press.toml:5:19: `size` wants a length with its unit, as text, got an integer `60`; write "
       "it "
       "as `\"60 mm\"`\n"
       "press.toml:5:23: `size` wants a length, got `60 kPa`, a pressure; write it as `60 mm`"},
  });
}

TEST(Refusals, Ranges) {
  const std::string range = "`; give a value in that range";
  const std::string volume =
      "`; for a tissue that keeps its volume give 0.49, which lowers the force by 1.3 % on deep "
      "tissue and by more on a thin layer";
  expect_refused({
      {"[tissue]\nyoung_modulus = \"0 kPa\"\n",
       "press.toml:5:17: `young_modulus` must be above 0 kPa, got `0 kPa" + range},
      {"[tissue]\nyoung_modulus = \"-3 kPa\"\n",
       "press.toml:5:17: `young_modulus` must be above 0 kPa, got `-3 kPa" + range},
      {"[tissue]\npoisson_ratio = -1\n",
       "press.toml:5:17: `poisson_ratio` must be above -1 and below 0.5, got `-1" + volume},
      {"[tissue]\npoisson_ratio = 0.5\n",
       "press.toml:5:17: `poisson_ratio` must be above -1 and below 0.5, got `0.5" + volume},
      {"[tissue]\ndensity = \"0 kg/m^3\"\n",
       "press.toml:5:11: `density` must be above 0 kg/m^3, got `0 kg/m^3" + range},
      {"[finger]\nradius = \"-11 mm\"\n",
       "press.toml:5:10: `radius` must be at least 1e-06 mm and at most 1e+06 mm, got `-11 mm" +
           range},
      {"[finger]\nradius = \"1e300 mm\"\n",
       "press.toml:5:10: `radius` must be at least 1e-06 mm and at most 1e+06 mm, got `1e300 mm" +
           range},
      {"[contact]\nfriction = -0.1\n",
       "press.toml:5:12: `friction` must be at least 0, got `-0.1" + range},
      {"[tissue]\nmesh = { cells = [3, 0, 6] }\n",
       "press.toml:5:22: `cells` must be at least 1 and at most 500, got `0" + range},
      {"[tissue]\nmesh = { cells = [3, 4] }\n",
       "press.toml:5:18: `cells` wants a list of 3, got a list of 2; write it as `[..., ..., "
       "...]`"},
      {"[output]\nforce_at = \"1 mm\"\n",
       "press.toml:5:12: `force_at` wants a list, got a text `1 mm`; write it as `force_at = "
       "[\"1 mm\"]`"},
      {"[output]\nforce_at = [\"1 mm\", 2]\n",
       "press.toml:5:21: `force_at` wants a length with its unit, as text, got an integer `2`; "
       "write it as `\"2 mm\"`"},
      {"[output]\nforce_at = [\"0 mm\"]\n",
       "press.toml:5:13: `force_at` must be above 0 mm, got `0 mm" + range},
      {"[output]\nforce_at = [\"1 mm\", \"2 mm\", \"0.1 cm\"]\n",
       "press.toml:5:12: `force_at` has 1 mm twice; keep one"},
      {"[solver]\ntolerance = 0\n",
       "press.toml:5:13: `tolerance` must be above 0 and below 1, got `0" + range},
      {"[solver]\nsubsteps = 0\n",
       "press.toml:5:12: `substeps` must be at least 1 and at most 1e+08, got `0" + range},
      {"[finger]\nspheres = 65\n",
       "press.toml:5:11: `spheres` must be at least 1 and at most 64, got `65" + range},
      {"[output]\ninterval = \"0 s\"\n",
       "press.toml:5:12: `interval` must be above 0 ms, got `0 s" + range},
  });
}

TEST(Refusals, NumbersThatAreNone) {
  expect_refused({
      {"[contact]\nfriction = nan\n",
       "press.toml:5:12: `friction` wants a finite number, got `nan`; write one as `0.5`"},
      {"[contact]\nfriction = -inf\n",
       "press.toml:5:12: `friction` wants a finite number, got `-inf`; write one as `0.5`"},
      {"[contact]\nfriction = 1e400\n",
       "press.toml:5:12: `1e400` is a number that no double can hold; write one between -1e300 and "
       "1e300"},
      {"[tissue]\ndensity = \"nan kg/m^3\"\n",
       "press.toml:5:11: `density` wants a density, got `nan kg/m^3`; write a finite number, as `1 "
       "kg/m^3`"},
      {"[tissue]\ndensity = \"inf kg/m^3\"\n",
       "press.toml:5:11: `density` wants a density, got `inf kg/m^3`; write a finite number, as `1 "
       "kg/m^3`"},
      {"[tissue]\ndensity = \"1e400 kg/m^3\"\n",
       "press.toml:5:11: `density` wants a density, got `1e400 kg/m^3`, which no double can hold; "
       "write a number between 1e-300 and 1e300 in size"},
  });
}

TEST(Refusals, Types) {
  expect_refused({
      {"[contact]\nfriction = \"0.3\"\n",
       "press.toml:5:12: `friction` wants a pure number, got a text `0.3`; write it as `friction = "
       "0.3`"},
      {"[contact]\nfriction = true\n",
       "press.toml:5:12: `friction` wants a pure number, got a truth value `true`; write it as "
       "`friction = 0.5`"},
      {"[tissue]\nmaterial = 5\n",
       "press.toml:5:12: `material` wants a text, got an integer `5`; write it as `material = "
       "\"5\"`"},
      {"[tissue]\nmaterial = []\n",
       "press.toml:5:12: `material` wants a text, got a list; write it as `material = \"...\"`"},
      {"[tissue]\nmaterial = 1979-05-27\n",
       "press.toml:5:12: `material` wants a text, got a date; write it as `material = \"...\"`"},
      {"[tissue]\nshape = \"cuboid\"\n",
       "press.toml:5:9: `shape` wants a table, got a text `cuboid`; write it as `shape = { ... }`"},
      {"[output]\nfits = 1\n",
       "press.toml:5:8: `fits` wants `true` or `false`, got an integer `1`; write it as `fits = "
       "true`"},
      {"[output]\ndisplay_scale = 2\n",
       "press.toml:5:17: `display_scale` wants a table, got an integer `2`; write it as "
       "`display_scale = { name = 1 }`"},
      {"[tissue]\nmesh = { cells = [3.0, 4, 6] }\n",
       "press.toml:5:19: `cells` wants a whole number, got a number `3.0`; write it as `3`"},
      {"[finger]\nspheres = 2.5\n",
       "press.toml:5:11: `spheres` wants a whole number, got a number `2.5`; write it as `spheres "
       "= "
       "2` or `3`"},
      {"[finger]\nspheres = 0.5\n",
       "press.toml:5:11: `spheres` wants a whole number, got a number `0.5`; write it as `spheres "
       "= "
       "1`"},
      {"[finger]\nspheres = 99.5\n",
       "press.toml:5:11: `spheres` wants a whole number, got a number `99.5`; write it as `spheres "
       "= 1`"},
  });
  EXPECT_EQ(refusal("step = 3\n"),
            "press.toml:1:8: `step` wants a list of tables, got an integer; write `[[step]]`");
  EXPECT_EQ(refusal("step = [1]\n"),
            "press.toml:1:9: `step` wants tables, got an integer; write `[[step]]`");
  EXPECT_EQ(refusal("[step]\nkind = \"indent\"\n"),
            "press.toml:1:1: `step` wants a list of tables, got a table; write `[[step]]`");
  EXPECT_EQ(refusal("schema = 2\n" + press),
            "press.toml:1:10: `schema` must be 1, got `2`; write that");
}

TEST(Refusals, DuplicatesAndBrokenFiles) {
  EXPECT_EQ(refusal("title = \"a\"\ntitle = \"b\"\n" + press),
            "press.toml:2:1: `title` is given twice; keep one of the two");
  expect_refused({{"[tissue]\nmaterial = \"skin\"\n[tissue]\nmaterial = \"bone\"\n",
                   "press.toml:6:1: `[tissue]` is given twice; keep one of the two"},
                  {"[tissue]\nmaterial = \"skin\n",
                   "press.toml:5:17: a text is not closed on its line; end it with the quote it "
                   "began with"}});
  EXPECT_EQ(refusal(""), "press.toml:1:1: the file is empty; a scenario starts with `schema = 1`");
  EXPECT_EQ(refusal("# nothing\n"),
            "press.toml:1:1: a scenario needs something to do; add a `[[step]]`, as `kind = "
            "\"indent\"`");
}

TEST(Refusals, TwoMistakesAreToldInTheOrderOfTheFile) {
  EXPECT_EQ(refusal("[tissue]\nyung = 1\nmaterial = \"skn\"\n[finger]\nmaterial = \"fingr\"\n"
                    "radius = \"5\"\n" +
                    press),
            "press.toml:2:1: `yung` is not a key here; known keys: base, base_height, base_side, "
            "branch, density, "
            "drag, instantaneous_ratio, material, mesh, poisson_ratio, relaxation_time, "
            "retardation_time, "
            "shape, viscosity, young_modulus\n"
            "press.toml:3:12: `material` does not know `skn`; did you mean `skin`? Known here: "
            "finger, skin, muscle, bone, ligament, upper_leg; your own tables are written "
            "`file.toml#name`\n"
            "press.toml:5:12: `material` does not know `fingr`; did you mean `finger`? Known here: "
            "finger, skin, muscle, bone, ligament, upper_leg; your own tables are written "
            "`file.toml#name`\n"
            "press.toml:6:10: `radius` wants a length with its unit, got `5`; write it as `5 mm`");
}

TEST(Refusals, OneMistakeIsOneMessage) {
  // The wrong model must not make `density` look misplaced too.
  EXPECT_EQ(
      refusal(press + "[solver]\nmodel = \"hertzz\"\n[tissue]\nviscosity = \"nodal_drag\"\n"
                      "drag = \"1 1/s\"\n"),
      "press.toml:5:9: `model` does not know `hertzz`; did you mean `hertz`? It is one of auto, "
      "hertz, layer, mass_spring, coupled_springs, solid");
  // The wrong depth must not make the next step look shallow, nor the rows too many.
  EXPECT_EQ(
      refusal("[[step]]\nkind = \"indent\"\nto = \"1e9 mm\"\n[[step]]\nkind = \"hold\"\n"),
      "press.toml:3:6: `to` of 1e+09 mm is deeper than the finger's radius of 11 mm, and a "
      "sphere presses with its lower half; press less deep, or give a larger `finger.radius`");
  EXPECT_EQ(refusal(press + "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[[step]]\nkind = "
                            "\"retract\"\nto = \"1.5 mm\"\n"),
            "press.toml:6:6: `indent` goes to 1 mm, which is not below the displacement of 2 mm "
            "before it; "
            "use `retract` to go back");
}

}  // namespace
}  // namespace palpate::scenario
