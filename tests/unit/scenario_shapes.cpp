// Shapes, regions and the files that hold them: read, refused, swept, written back.
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

const std::string tetgen = "mesh = { kind = \"tetgen\", nodes = 100 }\n";

std::string shape(const std::string& inside) { return "[tissue]\nshape = { " + inside + " }\n"; }

TEST(Shapes, OfEveryKindAreRead) {
  const auto cylinder = std::get<Cylinder>(
      read_one(press + shape("kind = \"cylinder\", radius = \"2 cm\", length = \"70 mm\""))
          .tissue.shape);
  EXPECT_EQ(cylinder.radius, 0.02);
  EXPECT_EQ(cylinder.length, 0.07);
  const auto ellipsoid = std::get<Ellipsoid>(
      read_one(press + shape("kind = \"ellipsoid\", size = [\"10 mm\", \"20 mm\", \"30 mm\"]"))
          .tissue.shape);
  EXPECT_EQ(ellipsoid.size, Vec3(0.01, 0.02, 0.03));
  const auto ligament = std::get<Ligament>(
      read_one(press + shape("kind = \"ligament\", length = \"50 mm\", width = \"20 mm\", "
                             "thickness = \"4 mm\""))
          .tissue.shape);
  EXPECT_EQ(ligament.length, 0.05);
  EXPECT_EQ(ligament.width, 0.02);
  EXPECT_EQ(ligament.thickness, 0.004);
  const auto shaft = std::get<BoneShaft>(
      read_one(press + shape("kind = \"bone_shaft\", length = \"90 mm\", radius = \"8 mm\", "
                             "end_radius = \"12 mm\""))
          .tissue.shape);
  EXPECT_EQ(shaft.length, 0.09);
  EXPECT_EQ(shaft.radius, 0.008);
  EXPECT_EQ(shaft.end_radius, 0.012);
  const auto limb = std::get<LayeredLimb>(
      read_one(press + shape("kind = \"layered_limb\", length = \"200 mm\", radius = \"50 mm\", "
                             "end_radius = \"40 mm\", skin_thickness = \"5 mm\", bone_radius = "
                             "\"9 mm\""))
          .tissue.shape);
  EXPECT_EQ(limb.length, 0.2);
  EXPECT_EQ(limb.radius, 0.05);
  EXPECT_EQ(limb.end_radius, 0.04);
  EXPECT_EQ(limb.skin_thickness, 0.005);
  EXPECT_EQ(limb.bone_radius, 0.009);
  const auto half = std::get<HalfSpace>(
      read_one(press + shape("kind = \"half_space\", curvature = \"-20 1/m\", curvature_2 = "
                             "\"0.05 1/mm\""))
          .tissue.shape);
  EXPECT_EQ(half.curvature, -20.0);
  EXPECT_EQ(half.curvature_2, 50.0);
}

TEST(Shapes, ThatAreNoBoxAreMeshedByTetgen) {
  for (const char* kind : {"cylinder", "ellipsoid", "ligament", "bone_shaft", "layered_limb"}) {
    const Scenario scenario = read_one(press + shape(std::string("kind = \"") + kind + "\""));
    EXPECT_EQ(std::get<Tetgen>(scenario.tissue.mesh).nodes, 728) << kind;
  }
  EXPECT_TRUE(std::holds_alternative<Mirrored>(read_one(press).tissue.mesh));
}

TEST(Shapes, MustBePositive) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> lengths{
      {"cylinder", {"radius", "length"}},
      {"ligament", {"length", "width", "thickness"}},
      {"bone_shaft", {"length", "radius", "end_radius"}},
      {"layered_limb", {"length", "radius", "end_radius", "skin_thickness", "bone_radius"}}};
  for (const auto& [kind, keys] : lengths)
    for (const std::string& key : keys) {
      const std::string before = "shape = { kind = \"" + kind + "\", " + key + " = ";
      EXPECT_EQ(refusal(press + "[tissue]\n" + before + "\"0 mm\" }\n"),
                "press.toml:5:" + std::to_string(before.size() + 1) + ": `" + key +
                    "` must be above 0 mm, got `0 mm`; give a value in that range");
    }
}

TEST(Shapes, GoWithTheirMeshes) {
  expect_refused({
      {shape("kind = \"cylinder\"") + "mesh = { kind = \"kuhn\" }\n",
       "press.toml:6:8: `kuhn` and `mirrored` cells fill a `cuboid` only; set `tissue.mesh = { "
       "kind = \"tetgen\", nodes = 728 }`"},
      {shape("kind = \"layered_limb\"") + "mesh = { cells = [2, 2, 2] }\n",
       "press.toml:6:8: `kuhn` and `mirrored` cells fill a `cuboid` only; set `tissue.mesh = { "
       "kind = \"tetgen\", nodes = 728 }`"},
      {"[tissue]\nmesh = { kind = \"tetgen\", tetrahedra = 500 }\n",
       "press.toml:5:40: `tetrahedra` is a target besides `nodes`, for shapes other than "
       "`cuboid` and surface files; remove it"},
      {shape("kind = \"cylinder\"") +
           "mesh = { kind = \"tetgen\", edge = \"5 mm\", tetrahedra = 500 }\n",
       "press.toml:6:55: `tetrahedra` is a target besides `nodes`, for shapes other than "
       "`cuboid` and surface files; remove it"},
      {shape("kind = \"as_meshed\""),
       "press.toml:5:9: `as_meshed` needs a ready mesh; set `tissue.mesh = { file = ..., unit = "
       "\"mm\" }`"},
      {shape("kind = \"as_meshed\"") + "mesh = { kind = \"kuhn\" }\n",
       "press.toml:5:9: `as_meshed` needs a ready mesh; set `tissue.mesh = { file = ..., unit = "
       "\"mm\" }`"},
      {shape("kind = \"sphere\""),
       "press.toml:5:18: `kind` does not know `sphere`; it is one of cuboid, cylinder, ellipsoid, "
       "ligament, bone_shaft, layered_limb, disc, half_space, file, as_meshed"},
  });
  EXPECT_EQ(notes(press + shape("kind = \"cylinder\"") +
                  "mesh = { kind = \"tetgen\", edge = \"5 mm\", nodes = 500 }\n"),
            "press.toml:6:42: `nodes` is left unread: it is used only without `edge`\n");
}

TEST(Shapes, AMeshThatIsTheBodyIsRead) {
  const std::string mesh = "mesh = { kind = \"file\", file = \"" PALPATE_SOURCE_DIR
                           "/tests/cases/scenes/skin_lump.msh\", unit = \"mm\" }\n";
  const std::string solid = "[solver]\nmodel = \"solid\"\n";
  const std::string body = shape("kind = \"as_meshed\"") + mesh;
  EXPECT_EQ(notes(press + body + solid), "");
  EXPECT_EQ(notes(press + body + "[solver]\nmodel = \"hertz\"\n"), "");
  EXPECT_EQ(notes(press + "[tissue]\n" + mesh + solid), "") << "without a shape it is the body too";
  EXPECT_EQ(refusal(press + shape("kind = \"ellipsoid\"") + mesh + solid),
            "press.toml:5:9: a ready mesh brings its own shape; remove `shape`, or mesh it with "
            "`tissue.mesh = { kind = \"tetgen\", nodes = 728 }`");
}

TEST(Shapes, HalfSpaceHasNoMesh) {
  const std::string half = shape("kind = \"half_space\"");
  EXPECT_EQ(refusal(press + half), "accepted") << "`auto` is `hertz` there";
  const std::string elsewhere =
      "it is used only on another `tissue.shape` than `half_space`; remove it or change that";
  expect_refused({
      {half + "[solver]\nmodel = \"mass_spring\"\n",
       "press.toml:5:9: a `half_space` has no mesh; set `solver.model = \"hertz\"` or another "
       "shape"},
      {half + "[[region]]\nkind = \"sphere\"\n",
       "press.toml:6:1: a `half_space` has no regions; use another `tissue.shape`"},
      {half + "density = \"1000 kg/m^3\"\n",
       "press.toml:6:1: `density` has no effect here: " + elsewhere},
  });
  expect_refused(
      {{half,
        "press.toml:5:9: `creep`, `relax` and `compress` need flat end faces, which a `half_space` "
        "does not have; use `cuboid`, `disc`, `cylinder`, `ligament`, `bone_shaft` or "
        "`layered_limb`"}},
      creep);
  EXPECT_EQ(notes(press + half + tetgen + "[solver]\nrings = 3\n"),
            "press.toml:6:1: `mesh` is left unread: it is used only on another `tissue.shape` than "
            "`half_space`\n"
            "press.toml:8:1: `rings` is left unread: it is used only on another `tissue.shape` "
            "than `half_space`\n");
  const std::string curved = shape("kind = \"half_space\", curvature = \"20 1/m\"");
  const std::string or_else = ", or use another `tissue.shape`, such as `ellipsoid`";
  expect_refused({
      {curved + "[finger]\nspheres = 2\n",
       "press.toml:7:11: there is no formula for several spheres on a curved `half_space`; set "
       "`spheres = "
       "1`" +
           or_else},
      {curved + "[finger]\nx = \"1 mm\"\n",
       "press.toml:7:5: there is no formula for a finger beside the top of a curved `half_space`; "
       "remove "
       "`x` and `y`" +
           or_else},
      {curved + "[[step]]\nkind = \"slide\"\n",
       "press.toml:6:1: there is no formula for a `slide` over a curved `half_space`; remove it" +
           or_else},
  });
  EXPECT_EQ(refusal(press + half +
                    "[finger]\nspheres = 2\nx = \"1 mm\"\n[[step]]\nkind = "
                    "\"slide\"\n"),
            "accepted")
      << "a flat is the same everywhere";
}

TEST(Shapes, WithoutFlatEndsDoNotCreep) {
  expect_refused(
      {{shape("kind = \"ellipsoid\""),
        "press.toml:5:9: `creep`, `relax` and `compress` need flat end faces, which an `ellipsoid` "
        "does not have; use `cuboid`, `disc`, `cylinder`, `ligament`, `bone_shaft` or "
        "`layered_limb`"}},
      creep);
  EXPECT_EQ(refusal(creep + shape("kind = \"bone_shaft\"")), "accepted");
}

// --- regions

TEST(Regions, TakeTheirSubstanceFromMaterialsUnlessTheySay) {
  const Scenario scenario = read_one(
      press + "[tissue]\n" + tetgen +
      "[[region]]\nkind = \"sphere\"\ncentre = [\"10 mm\", \"20 mm\", \"-1 mm\"]\nradius = \"3 "
      "mm\"\nmaterial = \"bone\"\nyoung_modulus = \"5 kPa\"\n"
      "[[region]]\ntag = 7\nkind = \"tagged\"\ndensity = \"900 kg/m^3\"\n");
  ASSERT_EQ(scenario.regions.size(), 2U);
  const auto& inclusion = std::get<Inclusion>(scenario.regions[0].part);
  EXPECT_EQ(inclusion.centre, (std::array<double, 3>{0.01, 0.02, -0.001}));
  EXPECT_EQ(inclusion.radius, 0.003);
  EXPECT_EQ(scenario.regions[0].young_modulus, 5000.0);
  const Scenario bone = read_one(press + "[tissue]\nmaterial = \"bone\"\n");
  EXPECT_EQ(scenario.regions[0].density, bone.tissue.density);
  const Region& tagged = scenario.regions[1];
  EXPECT_EQ(std::get<TaggedRegion>(tagged.part).tag, 7);
  EXPECT_EQ(tagged.material, "muscle");
  EXPECT_EQ(tagged.density, 900.0);
  const Scenario muscle = read_one(press + "[tissue]\nmaterial = \"muscle\"\n");
  EXPECT_EQ(tagged.young_modulus, muscle.tissue.young_modulus);
}

TEST(Regions, OfALimbAreMuscleAndBoneUnlessTheScenarioHasItsOwn) {
  const std::string limb = shape("kind = \"layered_limb\"");
  const Scenario plain = read_one(press + limb);
  ASSERT_EQ(plain.regions.size(), 2U);
  EXPECT_EQ(plain.regions[0].material, "muscle");
  EXPECT_EQ(std::get<TaggedRegion>(plain.regions[1].part).tag, 2);
  EXPECT_EQ(plain.regions[1].material, "bone");
  EXPECT_EQ(read_one(press + limb + "[[region]]\ntag = 2\n").regions.size(), 1U);
}

// Without a mesh of the scenario's own, the mesh suits the body and is refined.
TEST(Meshes, SuitTheBodyByDefault) {
  const auto nodes_wanted = [](const std::string& text) {
    const Scenario scenario = read_one(press + text);
    const auto* mesh = std::get_if<Tetgen>(&scenario.tissue.mesh);
    return mesh != nullptr ? mesh->nodes : 0;
  };
  const auto refined = [](const std::string& text) {
    const Scenario scenario = read_one(press + text);
    return refinement(scenario.tissue.mesh).refine;
  };
  EXPECT_EQ(nodes_wanted(""), 0);
  EXPECT_EQ(nodes_wanted("[[region]]\nkind = \"sphere\"\n"), 728);
  EXPECT_EQ(nodes_wanted("[tissue]\nshape = { kind = \"ellipsoid\" }\n"), 728);
  EXPECT_TRUE(refined(""));
  EXPECT_TRUE(refined("[tissue]\nshape = { kind = \"ellipsoid\" }\n"));
  EXPECT_FALSE(refined("[tissue]\nmesh = { kind = \"tetgen\", nodes = 400 }\n"));
  EXPECT_TRUE(refined("[tissue]\nmesh = { kind = \"mirrored\", refine = true }\n"));
}

TEST(Regions, AreRefusedAtTheirPlace) {
  expect_refused({
      {"[tissue]\nmesh = { kind = \"mirrored\" }\n[[region]]\nkind = \"sphere\"\n",
       "press.toml:5:8: a `sphere` region is meshed by TetGen only; set `tissue.mesh = { kind = "
       "\"tetgen\", nodes = 1500 }`"},
      {"[[region]]\nkind = \"slab\"\nbottom = \"10 mm\"\n",
       "press.toml:4:1: `top` is not above `bottom`; exchange the two"},
      {"[[region]]\nkind = \"slab\"\ntop = \"30 mm\"\n",
       "press.toml:6:7: `top` reaches the cuboid's top, which the finger presses; make that layer "
       "the "
       "`tissue` and what lies below it a `slab`"},
      {"[[region]]\nkind = \"slab\"\n[[region]]\nkind = \"slab\"\nbottom = \"9 mm\"\ntop = "
       "\"12 mm\"\n",
       "press.toml:8:10: another `slab` lies there too; give them different heights"},
      {"[[region]]\nkind = \"lump\"\n",
       "press.toml:5:8: `kind` does not know `lump`; it is one of tagged, sphere, slab"},
      {"[[region]]\ntag = -1\n",
       "press.toml:5:7: `tag` must be at least 0 and at most 1e+09, got `-1`; give a value in that "
       "range"},
      {"[[region]]\ntag = 1\n[[region]]\ntag = 1\n",
       "press.toml:7:7: another `[[region]]` has `tag` 1 too; keep one of the two"},
      {"[[region]]\nmaterial = \"skn\"\n",
       "press.toml:5:12: `material` does not know `skn`; did you mean `skin`? Known here: finger, "
       "skin, muscle, bone, ligament, upper_leg; your own tables are written `file.toml#name`"},
      {"[tissue]\n" + tetgen + "[[region]]\nkind = \"sphere\"\nradius = \"0 mm\"\n",
       "press.toml:8:10: `radius` must be above 0 mm, got `0 mm`; give a value in that range"},
      {"[tissue]\n" + tetgen + "[[region]]\nkind = \"sphere\"\nyoung_modulus = \"3 mm\"\n",
       "press.toml:8:17: `young_modulus` wants a pressure, got `3 mm`, a length; write it as `3 "
       "kPa`"},
  });
}

// --- families

std::vector<std::string> case_names(const std::string& text) {
  std::vector<std::string> names;
  for (const Case& one : parse(text, "press.toml", {}).cases) names.push_back(one.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(Families, SweepRegionsShapesAndSpheres) {
  const Family inclusions = parse(
      press + "[tissue]\n" + tetgen +
          "[[region]]\nkind = \"sphere\"\n[sweep]\n\"region.1.young_modulus\" = [\"1 kPa\", \"9 "
          "kPa\"]\n",
      "press.toml", {});
  ASSERT_EQ(inclusions.cases.size(), 2U);
  EXPECT_EQ(inclusions.cases[1].scenario.regions[0].young_modulus, 9000.0);
  EXPECT_EQ(echo(parse(echo(inclusions), "press.toml", {})), echo(inclusions));

  const Family curved = parse(press + shape("kind = \"half_space\"") +
                                  "[sweep]\n\"tissue.shape.curvature\" = [\"-5 1/m\", \"0 1/m\"]\n",
                              "press.toml", {});
  EXPECT_EQ(std::get<HalfSpace>(curved.cases.at(0).scenario.tissue.shape).curvature, -5.0);
  EXPECT_EQ(echo(parse(echo(curved), "press.toml", {})), echo(curved));

  const Family spheres = parse(press + "[sweep]\n\"finger.spheres\" = [1, 8]\n", "press.toml", {});
  EXPECT_EQ(spheres.cases.at(1).scenario.finger.spheres, 8);
  EXPECT_EQ(echo(parse(echo(spheres), "press.toml", {})), echo(spheres));
}

// The comment on each swept material lists its own properties, not those of the regions.
TEST(Families, OfMaterialsCommentOnTheTissue) {
  const std::string written =
      echo(parse(press + shape("kind = \"layered_limb\"") +
                     "[sweep]\n\"tissue.material\" = [\"skin\", \"ligament\"]\n",
                 "press.toml", {}));
  const std::size_t at = written.find("# skin:");
  ASSERT_NE(at, std::string::npos) << written;
  const std::string line = written.substr(at, written.find('\n', at) - at);
  EXPECT_EQ(line.find("young_modulus"), line.rfind("young_modulus")) << line;
  EXPECT_NE(line.find("young_modulus"), std::string::npos) << line;
}

TEST(Families, NameListsByTheirValues) {
  EXPECT_EQ(case_names(press + shape("kind = \"ellipsoid\"") +
                       "[sweep]\n\"tissue.shape.size\" = [[\"20 mm\", \"20 mm\", \"20 mm\"], [\"20 "
                       "mm\", \"30 mm\", \"40 mm\"]]\n"),
            (Names{"20 mm", "20 mm x 30 mm x 40 mm"}));
  EXPECT_EQ(case_names(press + "[sweep]\n\"tissue.mesh.cells\" = [[3, 4, 6], [2, 2, 2]]\n"),
            (Names{"3 x 4 x 6", "2"}));
  EXPECT_EQ(case_names(press + "[sweep]\nstep = [[{ kind = \"indent\" }], [{ kind = \"indent\", to "
                               "= \"1 N\" }]]\n"),
            (Names{"step1", "step2"}));
}

// --- files

class ShapeFiles : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "data"); }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    write_atomically((folder_ / name).string(), text);
  }
  [[nodiscard]] std::string said(const std::string& text) const {
    try {
      (void)parse(press + text, (folder_ / "press.toml").string(), {});
      return "accepted";
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string name = folder_.string() + "/";
      for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
        message.erase(at, name.size());
      return message;
    }
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / ("palpate_shapes_" + std::to_string(::getpid()));
};

TEST_F(ShapeFiles, NeedTheirFileAndUnit) {
  write("leg.stl", "solid\n");
  write("leg.msh", "$MeshFormat\n");
  EXPECT_EQ(said(shape("file = \"leg.stl\", unit = \"mm\"")), "accepted");
  EXPECT_EQ(said(shape("file = \"leg.stl\"")),
            "press.toml:5:9: `shape` lacks the unit of its coordinates; write `unit = \"mm\"`");
  EXPECT_EQ(said(shape("kind = \"file\", unit = \"mm\"")),
            "press.toml:5:9: `shape` of kind `file` lacks `file`; write `file = \"leg.stl\"`");
  EXPECT_EQ(said(shape("file = \"leg.stl\", unit = \"kPa\"")),
            "press.toml:5:36: `unit` wants a unit of length, got `kPa`; write `unit = \"mm\"`");
  EXPECT_EQ(said(shape("file = \"arm.stl\", unit = \"mm\"")),
            "press.toml:5:18: `file` names `arm.stl`, which cannot be read: No such file or "
            "directory; check the path");
  EXPECT_EQ(said("[tissue]\nmesh = { file = \"arm.msh\", unit = \"mm\" }\n"),
            "press.toml:5:17: `file` names `arm.msh`, which cannot be read: No such file or "
            "directory; check the path");
  EXPECT_EQ(said(shape("kind = \"cylinder\"") + "mesh = { file = \"leg.msh\", unit = \"mm\" }\n"),
            "press.toml:5:9: a ready mesh brings its own shape; remove `shape`, or mesh it with "
            "`tissue.mesh = { kind = \"tetgen\", nodes = 728 }`");
}

// A mesh file alone is the shape; the echo finds the copies beside it.
TEST_F(ShapeFiles, LieBesideTheEcho) {
  write("data/leg.stl", "solid\n");
  write("data/leg.msh", "$MeshFormat\n");
  for (const std::string& text :
       {shape("file = \"data/leg.stl\", unit = \"mm\"") + tetgen,
        "[tissue]\nmesh = { file = \"data/leg.msh\", unit = \"cm\" }\n[[region]]\ntag = 3\n"
        "[[region]]\ntag = 4\nmaterial = \"bone\"\n"s}) {
    const Family family = parse(press + text, (folder_ / "press.toml").string(), {});
    ASSERT_EQ(family.inputs.size(), 2U);
    const std::string& name = family.inputs[1].name;
    const std::string written = echo(family);
    EXPECT_EQ(written.find("data/"), std::string::npos) << written;
    EXPECT_NE(written.find("\"" + name + "\""), std::string::npos) << written;
    fs::create_directories(folder_ / "result");
    write("result/" + name, family.inputs[1].content);
    EXPECT_EQ(echo(parse(written, (folder_ / "result/press.toml").string(), {})), written);
  }
  const Scenario meshed =
      parse(press + "[tissue]\nmesh = { file = \"data/leg.msh\", unit = \"cm\" }\n",
            (folder_ / "press.toml").string(), {})
          .cases.at(0)
          .scenario;
  EXPECT_TRUE(std::holds_alternative<AsMeshed>(meshed.tissue.shape));
}

}  // namespace
}  // namespace palpate::scenario
