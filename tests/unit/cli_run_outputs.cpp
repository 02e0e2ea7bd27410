// Deformed meshes and pictures of a run: their names, numbers, times, and their place in run.json.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "program.h"

namespace palpate::test {
namespace {

const std::string press_given =
    "title = \"A press\"\n[tissue]\nmesh = { kind = \"mirrored\", cells = [4, 4, 3] }\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"10 mm/s\"\n"
    "[[step]]\nkind = \"slide\"\nby = \"2 mm\"\nrate = \"10 mm/s\"\n"
    "[output]\ninterval = \"50 ms\"\nfigures = false\nfits = false\npressure_maps = false\n"
    "tissue = true\npicture = true\n";

// The names in a folder with one of these endings.
std::set<std::string> files_of(const fs::path& folder) {
  std::set<std::string> found;
  for (const std::string& name : names_in(folder))
    if (name.ends_with(".vtu") || name.ends_with(".pvd") || name.ends_with(".svg"))
      found.insert(name);
  return found;
}

TEST(RunOutputs, of_one_case) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml", press_given);
  const Ended ended = palpate(folder.path(), {"run", "press.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const fs::path result = folder / "out/press";
  EXPECT_EQ(files_of(result),
            (std::set<std::string>{"scene.svg", "tissue.pvd", "tissue_001.vtu", "tissue_002.vtu"}));
  const std::string series = read_file(result / "tissue.pvd");
  EXPECT_NE(series.find("timestep=\"0.2\" part=\"0\" file=\"tissue_001.vtu\""), std::string::npos);
  EXPECT_NE(series.find("timestep=\"0.4\" part=\"0\" file=\"tissue_002.vtu\""), std::string::npos);
  const std::string frame = read_file(result / "tissue_001.vtu");
  for (const char* array :
       {"displacement_mm", "contact_pressure_kPa", "strain", "volume_change", "equivalent_strain"})
    EXPECT_NE(frame.find("Name=\"" + std::string(array) + "\""), std::string::npos) << array;
  EXPECT_NE(frame, read_file(result / "tissue_002.vtu")) << "the finger has slid";
  const std::string picture = read_file(result / "scene.svg");
  EXPECT_NE(picture.find("<title>A press</title>"), std::string::npos);
  EXPECT_NE(picture.find("<circle"), std::string::npos);
  EXPECT_NE(picture.find("stroke-dasharray"), std::string::npos) << "the slide";

  std::set<std::string> named;
  const auto manifest = nlohmann::json::parse(read_file(result / "run.json"));
  for (const auto& output : manifest["outputs"]) {
    named.insert(output["path"]);
    EXPECT_EQ(output["sha256"], sha256(read_file(result / std::string(output["path"]))));
  }
  for (const std::string& file : files_of(result)) EXPECT_TRUE(named.contains(file)) << file;
}

TEST(RunOutputs, of_several_cases) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml",
             press_given + "[sweep]\n\"finger.radius\" = [\"8 mm\", \"11 mm\"]\n");
  const Ended ended = palpate(folder.path(), {"run", "press.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const fs::path result = folder / "out/press";
  EXPECT_EQ(files_of(result),
            (std::set<std::string>{"scene_case_001.svg", "scene_case_002.svg",
                                   "tissue_case_001.pvd", "tissue_case_002.pvd", "tissue_001.vtu",
                                   "tissue_002.vtu", "tissue_003.vtu", "tissue_004.vtu"}));
  const std::string second = read_file(result / "tissue_case_002.pvd");
  EXPECT_EQ(second.find("tissue_002.vtu"), std::string::npos);
  EXPECT_NE(second.find("tissue_003.vtu"), std::string::npos);
  EXPECT_NE(second.find("tissue_004.vtu"), std::string::npos);
  EXPECT_NE(read_file(result / "scene_case_002.svg").find("<title>A press: 11 mm</title>"),
            std::string::npos);
}

TEST(RunOutputs, show_a_hidden_lump) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml",
             "[tissue]\nmesh = { kind = \"tetgen\", nodes = 300 }\n"
             "[[region]]\nkind = \"sphere\"\nradius = \"6 mm\"\nmaterial = \"muscle\"\n"
             "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
             "[output]\ninterval = \"200 ms\"\nfigures = false\npicture = true\n");
  const Ended ended = palpate(folder.path(), {"run", "press.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string picture = read_file(folder / "out/press/scene.svg");
  EXPECT_NE(picture.find("muscle (region 1)"), std::string::npos);
  const std::size_t glass = picture.find("opacity=\"0.45\"");
  ASSERT_NE(glass, std::string::npos);
  EXPECT_EQ(picture.find("opacity=\"0.45\"", glass + 1), std::string::npos) << "the lump is solid";
  EXPECT_LT(picture.find("<path fill=\"#"), glass) << "the lump comes first";
  EXPECT_LT(picture.find("<path fill=\"#", glass), picture.find("</g>", glass))
      << "the skin is the glass";
}

// Of 5 rows the first is that before the press; two steps share none.
TEST(RunOutputs, meshes_at_every_row) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml", press_given);
  const Ended ended = palpate(folder.path(), {"run", "press.toml", "--set", "output.tissue_at=rows",
                                              "--set", "output.interval=100 ms"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string series = read_file(folder / "out/press/tissue.pvd");
  for (const char* time : {"0", "0.1", "0.2", "0.3", "0.4"})
    EXPECT_NE(series.find("timestep=\"" + std::string(time)), std::string::npos) << series;
  EXPECT_EQ(files_of(folder / "out/press").size(), 7U) << "five meshes, their list and the scene";
}

TEST(RunOutputs, pressure_maps_as_pictures) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml",
             "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[output]\npng = true\n");
  const Ended ended = palpate(folder.path(), {"run", "press.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err.find("gnuplot"), std::string::npos) << ended.err;
  const fs::path result = folder / "out/press";
  EXPECT_TRUE(read_file(result / "pressure_001.png").starts_with("\x89PNG"));
  const std::string script = read_file(result / "pressure_001.gp");
  EXPECT_NE(script.find("set cblabel 'Pressure (kPa)'"), std::string::npos);
  const auto manifest = nlohmann::json::parse(read_file(result / "run.json"));
  std::set<std::string> named;
  for (const auto& output : manifest["outputs"]) named.insert(output["path"]);
  EXPECT_TRUE(named.contains("pressure_001.png"));
}

TEST(RunOutputs, only_on_request) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml", press_given);
  const Ended ended = palpate(folder.path(), {"run", "press.toml", "--set", "output.tissue=false",
                                              "--set", "output.picture=false"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(files_of(folder / "out/press").empty());
}

}  // namespace
}  // namespace palpate::test
