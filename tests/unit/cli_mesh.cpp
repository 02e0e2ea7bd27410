// `palpate convert` of bodies: what it says of surfaces, meshes and scenarios, what it writes, what
// it refuses.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

using Words = std::vector<std::string>;

// A cube of 10 units as quadrilaterals; without its lid it is open.
std::string cube_off(bool lid) {
  return std::string("OFF\n8 ") + (lid ? "6" : "5") +
         " 0\n0 0 0\n10 0 0\n10 10 0\n0 10 0\n0 0 10\n10 0 10\n10 10 10\n0 10 10\n"
         "4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n" +
         (lid ? "4 4 5 6 7\n" : "");
}

std::map<std::string, double> numbers(const std::string& csv) {
  std::map<std::string, double> found;
  for (const auto& row : record::parse_csv(csv, "stdout").rows)
    if (const auto* value = std::get_if<double>(&row[1]))
      found[std::get<std::string>(row[0])] = *value;
  return found;
}

class MeshVerb : public testing::Test {
 protected:
  MeshVerb() {
    write_file(folder_ / "cube.off", cube_off(true));
    write_file(folder_ / "open.off", cube_off(false));
    for (const char* name : {"box.node", "box.ele"})
      fs::copy_file(project_file(std::string("golden/meshes/") + name), folder_ / name);
  }
  Ended mesh(const Words& more) const { return palpate(folder_.path(), {"convert"}, more); }
  // What is said of a sound subject.
  std::map<std::string, double> quality(const Words& more) const {
    const Ended ended = mesh(more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return numbers(ended.out);
  }
  void expect_refused(int code, const Words& words, const std::string& sentence) const {
    const auto before = names_in(folder_.path());
    const Ended ended = mesh(words);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_EQ(ended.out, "");
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
    EXPECT_EQ(names_in(folder_.path()), before) << sentence;
  }
  TemporaryFolder folder_;
};

TEST_F(MeshVerb, TellsTheQualityOfAReadyMesh) {
  auto box = quality({"box.node", "--unit", "m"});
  EXPECT_EQ(box["nodes"], 200);
  EXPECT_EQ(box["tetrahedra"], 734);
  EXPECT_EQ(box["surface_triangles"],
            2 * box["surface_vertices"] - 4);                         // Euler, a body without holes
  EXPECT_NEAR(box["volume_mm3"], 108e3, 1e-6);                        // 60 x 60 x 30; rounding
  EXPECT_NEAR(box["surface_area_mm2"], 14.4e3, 1e-6);                 // rounding
  EXPECT_NEAR(box["highest_z_mm"] - box["lowest_z_mm"], 30.0, 1e-9);  // rounding
  EXPECT_EQ(box["regions"], 1);
  EXPECT_EQ(box["region_0_tetrahedra"], 734);
  EXPECT_EQ(box["region_0_volume_mm3"], box["volume_mm3"]);
  EXPECT_GT(box["smallest_dihedral_angle_deg"], 10.0);
  EXPECT_EQ(box["share_of_angles_below_10_deg"], 0.0);
  EXPECT_LT(box["largest_dihedral_angle_deg"], 180.0);
  EXPECT_GT(box["largest_edge_ratio"], 1.0);
  EXPECT_GE(box["limiting_tetrahedron"], 0);
  EXPECT_LT(box["limiting_altitude_mm"], box["shortest_edge_mm"]);
  EXPECT_EQ(quality({"box.ele", "--unit", "m"}), box);
  EXPECT_NEAR(quality({"box.node", "--unit", "mm"})["volume_mm3"], 108e-6, 1e-15);  // rounding
}

TEST_F(MeshVerb, FlatTetrahedraAreCounted) {
  // A regular-looking corner and a sliver beside it: one dihedral angle of the six is acos of
  // nearly 1 where the fifth node hardly leaves the plane.
  write_file(folder_ / "flat.node", "5 3 0 0\n0 0 0 0\n1 10 0 0\n2 0 10 0\n3 0 0 10\n4 5 5 -0.2\n");
  write_file(folder_ / "flat.ele", "2 4 0\n0 0 1 2 3\n1 0 2 1 4\n");
  auto flat = quality({"flat.node", "--unit", "mm"});
  EXPECT_EQ(flat["limiting_tetrahedron"], 1);
  EXPECT_LT(flat["smallest_dihedral_angle_deg"], 5.0);
  EXPECT_GT(flat["share_of_angles_below_10_deg"], 0.0);
  EXPECT_NEAR(flat["limiting_altitude_mm"], 0.2, 1e-3);  // other altitudes are longer
}

TEST_F(MeshVerb, MeshesASurfaceAndWritesIt) {
  auto cube =
      quality({"cube.off", "--unit", "mm", "--edge", "3 mm", "--out", "a.node", "--out", "a.vtu"});
  EXPECT_NEAR(cube["volume_mm3"], 1000.0, 1e-6);  // rounding
  EXPECT_GT(cube["nodes"], 30);                   // 8 corners and what the edge length asks for
  auto again = quality({"a.ele", "--unit", "m"});
  EXPECT_EQ(again, cube) << "the written mesh is the reported one";
  const std::string vtu = read_file(folder_ / "a.vtu");
  for (const std::string& part : {"NumberOfPoints=\"" + number_text(cube["nodes"]) + "\"",
                                  "NumberOfCells=\"" + number_text(cube["tetrahedra"]) + "\"",
                                  std::string("displacement_mm"), std::string("\"tissue\"")})
    EXPECT_NE(vtu.find(part), std::string::npos) << part;
  // Without a target as fine as the surface, 10 mm; about as many nodes as asked for.
  EXPECT_LT(quality({"cube.off", "--unit", "mm"})["nodes"], 30);
  EXPECT_NEAR(quality({"cube.off", "--unit", "mm", "--nodes", "200"})["nodes"], 200, 50);  // 25 %
}

TEST_F(MeshVerb, SaysIfTheSurfaceNeedsMoreNodes) {
  const Ended ended = mesh({"cube.off", "--unit", "mm", "--nodes", "4"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.err.find(" nodes instead of 4, because it keeps the surface's vertices"),
            std::string::npos)
      << ended.err;
}

TEST_F(MeshVerb, JsonIsTheSameTable) {
  const Ended csv = mesh({"box.node", "--unit", "m"});
  const Ended json = mesh({"box.node", "--unit", "m", "--json"});
  const auto object = nlohmann::json::parse(json.out);
  EXPECT_TRUE(object["nodes"].is_number_integer());
  std::map<std::string, double> found;
  for (const auto& [name, value] : object.items()) found[name] = value;
  EXPECT_EQ(found, numbers(csv.out));
}

TEST_F(MeshVerb, MeshesAScenarioAsARunWould) {
  const std::string cube = project_file("scenarios/model_cube.toml");
  auto report = quality({cube});
  EXPECT_EQ(report["nodes"], 140);
  EXPECT_EQ(report["tetrahedra"], 432);
  EXPECT_EQ(report["surface_vertices"], 110);
  EXPECT_EQ(report["surface_triangles"], 216);
  EXPECT_EQ(report["springs"], 679);
  const std::string limit = rounded_text(report["stable_step_ms"]) + " ms (2 / omega_max)";
  EXPECT_NE(palpate(folder_.path(), {"explain", cube}).out.find(limit), std::string::npos) << limit;
  EXPECT_EQ(quality({cube, "--set", "tissue.mesh.cells=[3, 3, 2]"})["tetrahedra"], 108);
}

TEST_F(MeshVerb, NamesAndMeasuresRegions) {
  write_file(folder_ / "lump.toml",
             "[tissue]\nmesh = { kind = \"tetgen\", nodes = 400 }\n[[region]]\nkind = \"sphere\"\n"
             "centre = [\"30 mm\", \"30 mm\", \"15 mm\"]\nradius = \"8 mm\"\nmaterial = \"bone\"\n"
             "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\n"
             "[sweep]\n\"finger.radius\" = [\"11 mm\", \"8 mm\"]\n");
  const Ended ended = mesh({"lump.toml", "--out", "lump.node"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("2 cases; this is the mesh of the first, 11 mm"), std::string::npos)
      << ended.err;
  auto report = numbers(ended.out);
  EXPECT_EQ(report["regions"], 2);
  EXPECT_NE(ended.out.find("region_1_material,bone\n"), std::string::npos) << ended.out;
  // Less than the ball of 2145 mm^3, whose surface is sampled; never more.
  EXPECT_GT(report["region_1_volume_mm3"], 1400.0);
  EXPECT_LT(report["region_1_volume_mm3"], 2145.0);
  EXPECT_NEAR(report["region_0_volume_mm3"] + report["region_1_volume_mm3"], 108e3,
              1e-6);  // rounding
  EXPECT_EQ(quality({"lump.node", "--unit", "m"})["region_1_tetrahedra"],
            report["region_1_tetrahedra"]);
}

// A plain block is pressed on a quarter of it.
TEST_F(MeshVerb, ShowsTheCornersOfTheSolidsMesh) {
  const std::string block = project_file("scenarios/quickstart.toml");
  const Ended ended = mesh({block, "--set", "solver.model=solid", "--out", "quarter.vtu"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("a half or a quarter of the body"), std::string::npos) << ended.err;
  auto report = numbers(ended.out);
  EXPECT_NEAR(4.0 * report["volume_mm3"], 108e3, 1e-6 * 108e3);  // 60 x 60 x 30 mm
  EXPECT_EQ(report.count("springs"), 0);
  EXPECT_EQ(quality({"quarter.vtu", "--unit", "mm"})["tetrahedra"], report["tetrahedra"]);
  expect_refused(2, {"quarter.vtu", "--unit", "m"}, "check its unit: in `cm` it would be 0.3 m");
}

// A cube without its lid, by the option that its refusal names.
TEST_F(MeshVerb, MendsAnOpenSurfaceAsFarAsIsAsked) {
  expect_refused(5, {"open.off", "--unit", "mm", "--repair-up-to", "0.1"},
                 "(`--repair-up-to 0.17` of `palpate convert`)");
  const Ended ended = mesh({"open.off", "--unit", "mm", "--repair-up-to", "0.17"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NEAR(numbers(ended.out)["volume_mm3"], 1000.0, 1e-6);
  expect_refused(2, {"box.node", "--unit", "m", "--repair-up-to", "0.1"},
                 "`--repair-up-to` is for surfaces");
  expect_refused(2, {project_file("scenarios/model_cube.toml"), "--repair-up-to", "0.1"},
                 "write `--set tissue.shape.repair_up_to=0.1`");
  expect_refused(2, {"open.off", "--unit", "mm", "--repair-up-to", "0.9"}, "--repair-up-to");
}

TEST_F(MeshVerb, RefusesWhatCannotServe) {
  expect_refused(5, {"open.off", "--unit", "mm", "--out", "a.vtu"}, "open.off");
  expect_refused(2, {"cube.off"}, "lacks the unit of the coordinates in cube.off");
  expect_refused(2, {"cube.off", "--unit", "kg"}, "`--unit` wants a unit of length, got `kg`");
  expect_refused(2, {"cube.off", "--unit", "mm", "--edge", "3 kPa"}, "`--edge` wants a length");
  expect_refused(2, {"cube.off", "--unit", "mm", "--edge", "-3 mm"}, "give a length above 0");
  expect_refused(2, {"cube.off", "--unit", "mm", "--edge", "3 mm", "--nodes", "90"}, "--nodes");
  expect_refused(2, {"cube.off", "--unit", "mm", "--set", "a=1"}, "`--set` is for scenarios");
  expect_refused(2, {"box.node", "--unit", "m", "--nodes", "90"}, "is a mesh already");
  expect_refused(2, {"no.stl", "--unit", "m"}, "no.stl");
  expect_refused(2, {"box.step", "--unit", "m"}, "box.step: is neither a surface");
  const std::string cube = project_file("scenarios/model_cube.toml");
  expect_refused(2, {cube, "--unit", "mm"}, "remove `--unit`");
  expect_refused(2, {cube, "--edge", "3 mm"}, "`--edge` is for surfaces");
  expect_refused(2, {cube, "--set", "solver.model=hertz"}, "`hertz`, which has no mesh");
}

TEST_F(MeshVerb, WritesSurfaces) {
  for (const char* out : {"copy.off", "copy.stl"}) {
    const double volume = quality({"cube.off", "--unit", "mm", "--out", out})["volume_mm3"];
    EXPECT_NEAR(quality({out, "--unit", "mm"})["volume_mm3"], volume, 1e-9) << out;  // rounding
  }
}

TEST_F(MeshVerb, ReplacesFilesOnlyWhereTold) {
  write_file(folder_ / "mine.ele", "precious");
  expect_refused(2, {"cube.off", "--unit", "mm", "--out", "mine.node"},
                 "mine.ele: is there already");
  EXPECT_EQ(read_file(folder_ / "mine.ele"), "precious");
  EXPECT_EQ(mesh({"open.off", "--unit", "mm", "--out", "mine.node", "--force"}).code, 5);
  EXPECT_EQ(read_file(folder_ / "mine.ele"), "precious") << "a refused surface leaves all as it is";
  (void)quality({"cube.off", "--unit", "mm", "--out", "mine.node", "--force"});
  EXPECT_NE(read_file(folder_ / "mine.ele"), "precious");
  (void)quality({"cube.off", "--unit", "mm", "--out", "mine.node"});  // the same mesh again
  const std::string before = read_file(folder_ / "box.node");
  expect_refused(2, {"box.ele", "--unit", "mm", "--out", "box.node", "--force"},
                 "box.node: is the input file");
  EXPECT_EQ(read_file(folder_ / "box.node"), before);
  expect_refused(2, {"cube.off", "--unit", "mm", "--out", "a.step"}, "wants the ending");
  expect_refused(2, {"box.node", "--unit", "m", "--out", "a.stl"}, "is for surfaces");
  (void)quality({"cube.off", "--unit", "mm", "--out", "made/a.vtu"});
  EXPECT_TRUE(fs::exists(folder_ / "made/a.vtu"));
}

}  // namespace
}  // namespace palpate::test
