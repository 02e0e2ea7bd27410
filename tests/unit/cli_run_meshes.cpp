// Runs on surfaces and meshes of other programs, broken ones too; meshes and fingers that do not
// fit together; and every scenario of ours up to the first touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "base/text.h"
#include "geometry/cuboid.h"
#include "program.h"
#include "record/csv.h"
#include "scene/first_touch.h"
#include "scene_text.h"

namespace palpate::test {
namespace {

using Faces = std::vector<std::array<int, 4>>;

// A box of 60 x 60 x 30 units as quadrilaterals.
const std::vector<Vec3> corners_given{{0, 0, 0},  {60, 0, 0},  {60, 60, 0},  {0, 60, 0},
                                      {0, 0, 30}, {60, 0, 30}, {60, 60, 30}, {0, 60, 30}};
const Faces sides{{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5},
                  {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};

std::string point(const Vec3& p) {
  return number_text(p.x()) + " " + number_text(p.y()) + " " + number_text(p.z());
}

std::string off(const std::vector<Vec3>& corners, const Faces& faces) {
  std::string text =
      "OFF\n" + std::to_string(corners.size()) + " " + std::to_string(faces.size()) + " 0\n";
  for (const Vec3& corner : corners) text += point(corner) + "\n";
  for (const auto& f : faces)
    text += "4 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
            " " + std::to_string(f[3]) + "\n";
  return text;
}

std::string obj() {
  std::string text;
  for (const Vec3& corner : corners_given) text += "v " + point(corner) + "\n";
  for (const auto& f : sides)
    text += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
            std::to_string(f[2] + 1) + " " + std::to_string(f[3] + 1) + "\n";
  return text;
}

std::string ply() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string body = off(corners_given, sides);
  return text + body.substr(body.find("0\n") + 2);
}

std::string stl() {
  std::string text = "solid box\n";
  for (const auto& f : sides)
    for (const auto& three : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const int v : three)
        text += "vertex " + point(corners_given[static_cast<std::size_t>(v)]) + "\n";
      text += "endloop\nendfacet\n";
    }
  return text + "endsolid box\n";
}

const std::string steps =
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
    "[output]\ninterval = \"100 ms\"\nfigures = false\nfits = false\npressure_maps = false\n";

class RunMeshes : public testing::Test {
 protected:
  Ended run(const std::string& text, const std::vector<std::string>& more = {}) const {
    write_file(folder_ / "press.toml", text);
    return palpate(folder_.path(), {"run", "press.toml", "--force"}, more);
  }
  [[nodiscard]] fs::path result() const { return folder_ / "out/press"; }
  [[nodiscard]] double last_force(const fs::path& folder = {}) const {
    const record::Table table =
        record::read_csv((folder.empty() ? result() : folder) / "force_indentation.csv");
    return std::get<double>(table.rows.back()[static_cast<std::size_t>(table.find("force_N"))]);
  }
  void expect_refused(const std::string& text, int code, const std::string& sentence) const {
    const Ended ended = run(text);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_EQ(ended.out, "");
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
    EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) << "no leftovers";
  }

  TemporaryFolder folder_;
};

std::string of_surface(const std::string& name, int nodes = 200) {
  return "[tissue]\nshape = { file = \"" + name +
         "\", unit = \"mm\" }\nmesh = { kind = \"tetgen\", "
         "nodes = " +
         std::to_string(nodes) + " }\n" + steps;
}

TEST_F(RunMeshes, surfaces_of_every_format_give_one_result) {
  write_file(folder_ / "box.off", off(corners_given, sides));
  write_file(folder_ / "box.obj", obj());
  write_file(folder_ / "box.ply", ply());
  write_file(folder_ / "box.stl", stl());
  std::string first;
  for (const char* name : {"box.off", "box.obj", "box.ply", "box.stl"}) {
    const Ended ended = run(of_surface(name));
    ASSERT_EQ(ended.code, 0) << name << ": " << ended.err;
    const std::string curve = read_file(folder_ / "out/press/force_indentation.csv");
    if (first.empty()) first = curve;
    EXPECT_EQ(curve, first) << name;
    EXPECT_EQ(read_file(folder_ / "out/press" / name), read_file(folder_ / name));
    // The echo finds the copy beside it.
    const Ended again =
        palpate(folder_ / "out/press", {"run", "scenario.toml", "--out", "../../again", "--force"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(last_force(folder_ / "again/scenario"), last_force()) << name;
  }
}

TEST_F(RunMeshes, broken_surfaces_are_refused_and_leave_nothing) {
  const std::string sound = off(corners_given, sides);
  const auto refused = [&](const std::string& text, const std::string& sentence) {
    write_file(folder_ / "leg.off", text);
    std::string scenario = of_surface("leg.off");
    scenario.insert(scenario.find(" }"), ", repair = false");
    expect_refused(scenario, 5, sentence);
  };
  refused(off(corners_given, Faces(sides.begin(), sides.end() - 1)),
          "palpate: surface `leg.off`: is open: 4 edges in 1 hole belong to one face only");
  std::vector<Vec3> pierced = corners_given;
  pierced[6] = Vec3(20, 20, -10);  // the top's corner, through the bottom
  refused(off(pierced, sides),
          "palpate: surface `leg.off`: faces 0 and 6 cut, touch or overlap each other");
  std::vector<Vec3> two = corners_given;
  Faces twice = sides;
  for (const Vec3& corner : corners_given) two.push_back(corner + Vec3(100, 0, 0));
  for (const auto& f : sides) twice.push_back({f[0] + 8, f[1] + 8, f[2] + 8, f[3] + 8});
  refused(off(two, twice), "palpate: surface `leg.off`: has 2 parts");
  write_file(folder_ / "leg.off", sound.substr(0, sound.size() / 2));
  expect_refused(of_surface("leg.off"), 2,
                 "leg.off:2: the header counts 8 vertices and 6 faces, but 8 lines follow");
  Faces inverted = sides;
  for (auto& f : inverted) std::swap(f[1], f[3]);
  refused(off(corners_given, inverted), "palpate: surface `leg.off`: is inside out");
}

TEST_F(RunMeshes, small_faults_are_mended_and_told) {
  Faces inverted = sides;
  for (auto& f : inverted) std::swap(f[1], f[3]);
  write_file(folder_ / "leg.off", off(corners_given, inverted));
  const Ended ended = run(of_surface("leg.off"));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("the surface of leg.off was mended: all triangles turned outwards"),
            std::string::npos)
      << ended.err;
}

TEST_F(RunMeshes, only_flat_ends_take_platens) {
  const std::string creep =
      "[[step]]\nkind = \"creep\"\n[solver]\nintegrator = \"quasi_static\"\n"
      "[output]\ninterval = \"100 ms\"\nfigures = false\nfits = false\n";
  write_file(folder_ / "box.off", off(corners_given, sides));
  const Ended flat =
      run("[tissue]\nshape = { file = \"box.off\", unit = \"mm\" }\nmesh = { kind = \"tetgen\", "
          "nodes = 200 }\n" +
          creep);
  EXPECT_EQ(flat.code, 0) << flat.err;
  fs::remove_all(folder_ / "out");
  const Ended made = palpate(
      folder_.path(), {"convert", project_file("scenarios/model_head.toml"), "--out", "head.node"});
  ASSERT_EQ(made.code, 0) << made.err;
  expect_refused("[tissue]\nmesh = { file = \"head.node\", unit = \"m\" }\n" + creep, 5,
                 "the specimen has no flat upper end for a platen");
}

// --- ready meshes

// The box of 60 x 60 x 30 mm in two layers, groups 7 below and 3 above, as Gmsh writes it.
struct Layered {
  geometry::TetMesh mesh =
      geometry::cuboid({0.06, 0.06, 0.03}, {4, 4, 2}, geometry::CellPattern::mirrored);

  [[nodiscard]] std::string nodes() const {
    std::string text;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      text += std::to_string(i + 1) + " " + point(1e3 * mesh.nodes[i]) + "\n";
    return text;
  }
  [[nodiscard]] bool below(const std::array<int, 4>& t) const {
    double sum = 0.0;
    for (const int n : t) sum += mesh.nodes[static_cast<std::size_t>(n)].z();
    return sum < 4 * 0.015;
  }
  [[nodiscard]] static std::string words(const std::array<int, 4>& t) {
    std::string text;
    for (const int n : t) text += " " + std::to_string(n + 1);
    return text + "\n";
  }
  [[nodiscard]] std::string version2() const {
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" +
                       std::to_string(mesh.nodes.size()) + "\n" + nodes() +
                       "$EndNodes\n$Elements\n" + std::to_string(mesh.tetrahedra.size()) + "\n";
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
      text += std::to_string(i + 1) + " 4 2 " + (below(mesh.tetrahedra[i]) ? "7 1" : "3 2") +
              words(mesh.tetrahedra[i]);
    return text + "$EndElements\n";
  }
  // Elements stand in blocks of an entity: those below come first.
  [[nodiscard]] std::string version4() const {
    const std::string count = std::to_string(mesh.nodes.size());
    std::string text =
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 2\n1 0 0 0 60 60 15 1 7 0\n2 0 0 "
        "15 "
        "60 60 30 1 3 0\n$EndEntities\n$Nodes\n1 " +
        count + " 1 " + count + "\n3 1 0 " + count + "\n";
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) text += std::to_string(i + 1) + "\n";
    for (const Vec3& node : mesh.nodes) text += point(1e3 * node) + "\n";
    const std::string all = std::to_string(mesh.tetrahedra.size());
    text += "$EndNodes\n$Elements\n2 " + all + " 1 " + all + "\n";
    int number = 0;
    for (const bool lower : {true, false}) {
      const auto here = [&](const auto& t) { return below(t) == lower; };
      text += std::string("3 ") + (lower ? "1" : "2") + " 4 " +
              std::to_string(std::count_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), here)) +
              "\n";
      for (const auto& t : mesh.tetrahedra)
        if (here(t)) text += std::to_string(++number) + words(t);
    }
    return text + "$EndElements\n";
  }
};

std::string of_mesh(const std::string& regions, const std::string& name = "box.msh") {
  return "[tissue]\nmaterial = \"muscle\"\nmesh = { file = \"" + name + "\", unit = \"mm\" }\n" +
         regions + steps;
}

TEST_F(RunMeshes, gmsh_files_of_both_versions_have_regions) {
  const Layered layered;
  const std::string stiff = "[[region]]\ntag = 7\nmaterial = \"ligament\"\n";
  std::vector<double> forces;
  for (const std::string& text : {layered.version2(), layered.version4()}) {
    write_file(folder_ / "box.msh", text);
    const Ended ended = run(of_mesh(stiff + "[[region]]\ntag = 3\n"));
    ASSERT_EQ(ended.code, 0) << ended.err;
    forces.push_back(last_force());
  }
  EXPECT_NEAR(forces[0], forces[1], 1e-6 * forces[0]);  // the same tetrahedra in another order
  ASSERT_EQ(run(of_mesh("")).code, 0) << "regions without a table are the tissue";
  EXPECT_GT(forces[0], 1.01 * last_force()) << "five times as stiff below";
}

// A finer mesh of the same block states a smaller error; other couplings state none.
TEST_F(RunMeshes, explain_states_the_meshs_own_error) {
  const auto stated = [&](const std::string& cells, const std::string& more) {
    write_file(folder_ / "block.toml", "[tissue]\nmesh = { kind = \"mirrored\", cells = " + cells +
                                           " }\n[solver]\nmodel = \"coupled_springs\"\n" + more +
                                           "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n");
    const std::string said = palpate(folder_.path(), {"explain", "block.toml"}).out;
    const std::string key = "mesh error   about ";
    const auto at = said.find(key);
    return at == std::string::npos ? -1.0 : std::stod(said.substr(at + key.size()));
  };
  const double coarse = stated("[3, 4, 6]", "");
  EXPECT_GT(coarse, 0.1);  // percent
  EXPECT_LT(coarse, 5.0);
  EXPECT_LT(stated("[6, 6, 6]", ""), 0.7 * coarse);
  EXPECT_EQ(stated("[3, 4, 6]", "[contact]\ncoupling = \"one_way\"\n"), -1.0);
}

TEST_F(RunMeshes, regions_that_are_not_there) {
  write_file(folder_ / "box.msh", Layered().version2());
  expect_refused(of_mesh("[[region]]\ntag = 3\n[[region]]\ntag = 9\n"), 2,
                 "the specimen's mesh has no tetrahedron of `[[region]]` 2; check its `tag`");
  expect_refused(of_mesh("[[region]]\nname = \"bone\"\n"), 2,
                 "the mesh has no region with the name `bone` of `[[region]]` 1; its file has no "
                 "names, write `tag` with a number");
  expect_refused("[[region]]\ntag = 1\n" + steps, 2,
                 "press.toml:2:7: the specimen's mesh has no tetrahedron of `[[region]]` 1; check "
                 "its `tag`");
  const std::string lump =
      "[tissue]\nmesh = { kind = \"tetgen\", nodes = 300 }\n[[region]]\nkind = \"sphere\"\nradius "
      "= "
      "\"4 mm\"\n";
  expect_refused(lump + "centre = [\"90 mm\", \"30 mm\", \"15 mm\"]\n" + steps, 2,
                 "`[[region]]` 1 lies outside the body: it has x 86 to 94, y 26 to 34, z 11 to 19 "
                 "mm, the body "
                 "x 0 to 60, y 0 to 60, z 0 to 30 mm");
  expect_refused(lump + "centre = [\"30 mm\", \"30 mm\", \"28 mm\"]\n" + steps, 2,
                 "only 84 % of `[[region]]` 1 lies inside the body");
}

TEST_F(RunMeshes, a_finger_beside_the_specimen) {
  expect_refused(
      "[finger]\nx = \"500 mm\"\n" + steps, 2,
      "press.toml:2:5: the finger passes beside the specimen at x 500 mm, y 30 mm, where "
      "it has nothing: its box has x 0 to 60, y 0 to 60, z 0 to 30 mm; set "
      "`finger.x` and `finger.y` to a place above it");
}

// --- what `hertz` does not know

TEST_F(RunMeshes, hertz_refuses_what_only_a_mesh_knows) {
  const std::string hertz =
      "[[step]]\nkind = \"indent\"\n[output]\nfigures = false\n[solver]\nmodel = \"hertz\"\n";
  const auto sentence = [](const std::string& reason) {
    return "press.toml:6:9: `hertz` cannot compute this scene: " + reason +
           "; set `solver.model = \"auto\"`, which takes one that can";
  };
  const std::string cylinder = hertz + "[tissue]\nshape = { kind = \"cylinder\" }\n";
  expect_refused(cylinder + "[finger]\nspheres = 3\n", 2,
                 sentence("several spheres meet a curved surface"));
  expect_refused(cylinder + "[[step]]\nkind = \"slide\"\n", 2,
                 sentence("the finger slides over a curved surface"));
  expect_refused(hertz + "[[region]]\ntag = 1\n", 2, sentence("the body has several tissues"));
  expect_refused(hertz + "[finger]\ny = \"61 mm\"\n", 2,
                 sentence("the finger leaves the top of the body"));
  expect_refused(hertz + "[[step]]\nkind = \"slide\"\nby = \"31 mm\"\n", 2,
                 sentence("the finger leaves the top of the body"));
  EXPECT_EQ(run(cylinder).code, 0);
  EXPECT_EQ(run(hertz + "[[step]]\nkind = \"slide\"\nby = \"29 mm\"\n").code, 0);
}

TEST_F(RunMeshes, a_body_that_is_not_held_below_the_press_is_said_to_bend) {
  const auto bends = [&](const std::string& shape) {
    const Ended ended = run("[tissue]\nmaterial = \"skin\"\nshape = { " + shape +
                            " }\n[[step]]\nkind = \"indent\"\nto = \"0.3 mm\"\n[output]\nfigures = "
                            "false\n[solver]\nmodel = \"solid\"\n");
    EXPECT_EQ(ended.code, 0) << ended.err;
    return (ended.out + ended.err).find("the body bends or turns there") != std::string::npos;
  };
  EXPECT_FALSE(bends("size = [\"60 mm\", \"60 mm\", \"7 mm\"]"));  // wide and thin
  EXPECT_TRUE(bends("kind = \"bone_shaft\""));                     // it lies on its ends
}

// Spheres that stand for one press a flat layer as it does, by every model, and state the same
// error.
TEST_F(RunMeshes, spheres_that_stand_for_one_have_its_force_on_a_layer) {
  const auto forces = [&](const std::string& model, int spheres) {
    const Ended ended =
        run("[tissue]\nmaterial = \"skin\"\nshape = { size = [\"60 mm\", \"60 mm\", \"12 mm\"] }\n"
            "viscosity = \"none\"\n[finger]\nradius = \"8 mm\"\nspheres = " +
            std::to_string(spheres) +
            "\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[output]\nfigures = false\n" + model);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const std::string said = ended.out + ended.err;
    const auto at = said.find("Peak force: ");
    return at == std::string::npos ? said : said.substr(at, said.find('(', at) - at);
  };
  for (const char* model : {"layer", "coupled_springs", "solid"}) {
    const std::string named = "[solver]\nmodel = \"" + std::string(model) + "\"\n";
    const std::string one = forces(named, 1);
    EXPECT_NE(one.find(" N, with an error of about "), std::string::npos) << one;
    EXPECT_EQ(forces(named, 3), one) << model;
    EXPECT_EQ(forces(named, 16), one) << model;
  }
}

TEST_F(RunMeshes, spheres_that_stand_for_one_are_told_apart_from_it_on_a_curve) {
  const auto said = [&](const std::string& shape, const char* model) {
    const Ended ended = run(
        "[tissue]\nmaterial = \"skin\"\nshape = { " + shape +
        " }\nviscosity = \"none\"\n[finger]\n"
        "radius = \"8 mm\"\nspheres = 4\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n[output]\n"
        "figures = false\n[solver]\nmodel = \"" +
        model + "\"\n");
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out + ended.err;
  };
  const std::string round = "kind = \"cylinder\", radius = \"30 mm\", length = \"60 mm\"";
  EXPECT_NE(said(round, "solid").find("`solid` has pressed the one"), std::string::npos);
  EXPECT_NE(said(round, "coupled_springs").find("each of them was pressed"), std::string::npos);
  const std::string flat = "size = [\"60 mm\", \"60 mm\", \"12 mm\"]";
  EXPECT_EQ(said(flat, "solid").find("several spheres"), std::string::npos);
}

TEST_F(RunMeshes, auto_is_hertz_on_a_half_space) {
  const std::string half =
      "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = "
      "\"indent\"\n[output]\nfigures = false\n";
  const Ended ended = run(half);
  EXPECT_EQ(ended.code, 0) << ended.err;
  const double force = last_force();
  ASSERT_EQ(run(half + "[solver]\nmodel = \"hertz\"\n").code, 0);
  EXPECT_EQ(force, last_force());
}

// A scene whose finger slides towards a side is no half-space to `auto`, wherever it began.
TEST_F(RunMeshes, auto_sees_the_side_that_the_finger_slides_to) {
  const std::string slow =
      "[tissue]\nshape = { size = [\"600 mm\", \"600 mm\", \"600 mm\"] }\nviscosity = "
      "\"none\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
  const auto chosen = [&](const std::string& more) {
    write_file(folder_ / "far.toml", slow + more);
    const std::string said = palpate(folder_.path(), {"explain", "far.toml"}).out;
    return said.find("model        hertz, chosen") != std::string::npos ? "hertz" : "another";
  };
  EXPECT_STREQ(chosen("[[step]]\nkind = \"slide\"\nby = \"100 mm\"\n"), "hertz");
  EXPECT_STREQ(chosen("[[step]]\nkind = \"slide\"\nby = \"280 mm\"\n"), "another");
  EXPECT_STREQ(chosen("[finger]\ny = \"20 mm\"\n"), "another");
}

TEST_F(RunMeshes, rings_are_left_unread_without_a_mesh) {
  const std::string hertz =
      "[[step]]\nkind = \"indent\"\n[output]\nfigures = false\n[solver]\n"
      "model = \"hertz\"\n";
  const Ended ended = run(hertz + "rings = 3\n");
  EXPECT_EQ(ended.code, 0) << ended.signal << ended.err;
  EXPECT_NE(ended.err.find("note: press.toml:7:1: `rings` is left unread"), std::string::npos);
  // A note is no error: `explain` has it without a colour, and not where only errors are wanted.
  const auto explained = [&](const Words& more) {
    return palpate(folder_.path(), {"explain", "press.toml"}, more).err;
  };
  EXPECT_TRUE(explained({}).starts_with("note: press.toml:7:1: `rings` is left unread"));
  EXPECT_EQ(explained({"--quiet"}), "");
}

TEST_F(RunMeshes, tissue_that_conforms_to_the_finger_diverges) {
  const Ended ended =
      run("[tissue]\nshape = { kind = \"half_space\", curvature = \"-200 1/m\" }\n"
          "[[step]]\nkind = \"indent\"\n[output]\nfigures = false\n");
  EXPECT_EQ(ended.code, 4);
  EXPECT_NE(ended.err.find("the tissue is hollow and conforms to the finger (curvature -200 1/m): "
                           "Hertz does not hold there"),
            std::string::npos)
      << ended.err;
  const record::Table findings = record::read_csv(result() / "findings.csv");
  EXPECT_EQ(findings.rows.at(0).at(static_cast<std::size_t>(findings.find("outcome"))),
            record::Cell("diverged"));
}

// --- every scenario of ours

std::vector<std::string> our_scenarios() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(project_file("scenarios")))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

class OurScenario : public testing::TestWithParam<std::string> {};

TEST_P(OurScenario, builds_its_first_case) {
  const scenario::Family family =
      scenario::read(project_file("scenarios/" + GetParam() + ".toml"), {});
  const scene::Scene scene = first_scene(family);
  const bool noted = GetParam() == "eight_spheres" || GetParam() == "sweep_modulus_ratio";
  EXPECT_NE(family.notes.empty(), noted);
  if (!scene.specimen) return;
  EXPECT_GT(scene::stability_limit(scene.scenario, *scene.specimen, scene.specimen->plan.contact),
            0.0);
  EXPECT_GT(scene.specimen->measured.young_modulus, 0.0);
  if (!scene.scenario.uniform()) {
    EXPECT_GT(scene::first_touch(scene).finger.z(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, OurScenario, testing::ValuesIn(our_scenarios()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace palpate::test
