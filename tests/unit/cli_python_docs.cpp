// The scripts of docs/python.md, as they are, on results of the kinds that they are for.
#include <gtest/gtest.h>

#include "base/text.h"
#include "program.h"

namespace palpate::test {
namespace {

// The scripts by the headings above them.
std::vector<std::pair<std::string, std::string>> scripts() {
  std::vector<std::pair<std::string, std::string>> found;
  std::string heading;
  bool inside = false;
  for (const std::string& line : split(read_file(project_file("docs/python.md")), '\n')) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (line == "```python") found.emplace_back(heading, "");
    if (inside && line != "```") found.back().second += line + "\n";
    inside = line == "```python" || (inside && line != "```");
  }
  return found;
}

class PythonDocs : public testing::Test {
 protected:
  void results(const std::vector<std::string>& words) const {
    const Ended ended = palpate(folder_.path(), words, {"--quiet"});
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  static std::string scenario(const std::string& name) {
    return project_file("scenarios/" + name + ".toml");
  }
  // Runs the script below the heading that begins so, and returns what it prints.
  [[nodiscard]] std::string run(const std::string& heading, const std::string& picture) const {
    for (const auto& [above, script] : scripts()) {
      if (!above.starts_with(heading)) continue;
      const Ended ended =
          run_program({.arguments = {"-W", "error::FutureWarning", "-W",
                                     "error::DeprecationWarning:__main__", "-c", script},
                       .folder = folder_.path(),
                       .set = {{"MPLCONFIGDIR", folder_.path().string()}},
                       .program = "/usr/bin/python3"});
      EXPECT_EQ(ended.code, 0) << ended.err;
      EXPECT_TRUE(read_file(folder_ / picture).starts_with("\x89PNG"));
      return ended.out;
    }
    ADD_FAILURE() << "no script below " << heading;
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(PythonDocs, a_press_and_its_findings) {
  results({"run", scenario("figure6_force_indentation")});
  EXPECT_NE(run("A press", "press.png").find("muscle"), std::string::npos);
  EXPECT_NE(run("What was found", "findings.png").find("peak_force_N"), std::string::npos);
}

TEST_F(PythonDocs, creep) {
  results({"run", scenario("figure7_skin_ligament"), "--set", "output.figures=false"});
  EXPECT_NE(run("Creep or relaxation", "creep.png").find("ligament"), std::string::npos);
}

TEST_F(PythonDocs, a_sweep) {
  std::string small = read_file(scenario("sweep_modulus_ratio"));
  for (std::size_t at = small.find("points = 20"); at != std::string::npos;
       at = small.find("points = 20"))
    small.replace(at, 11, "points = 3");
  write_file(folder_ / "sweep_modulus_ratio.toml", small);
  results({"sweep", "plan", "sweep_modulus_ratio.toml"});
  results({"sweep", "run", "out/sweep_modulus_ratio_sweep"});
  results({"sweep", "merge", "out/sweep_modulus_ratio_sweep"});
  EXPECT_NE(run("A sweep", "sweep.png").find("force_indentation_power_n"), std::string::npos);
}

TEST_F(PythonDocs, an_identification) {
  results({"run", scenario("quickstart"), "--set", "output.figures=false"});
  results({"identify", "out/quickstart/force_indentation.csv", scenario("quickstart"), "--x",
           "travel_mm", "--y", "force_N", "--unknown", "tissue.young_modulus=1 kPa..500 kPa"});
  EXPECT_NE(run("A measured curve", "identified.png").find("72.4"), std::string::npos);
}

TEST_F(PythonDocs, a_chart) {
  // The columns of a chart do not depend on the steps; the reference of this one is a formula.
  write_file(
      folder_ / "quickstart.toml",
      "[tissue.mesh]\nkind = \"kuhn\"\ncells = [2, 2, 1]\n[[step]]\nkind = \"creep\"\nstress = "
      "\"1 kPa\"\nload_time = \"0.1 s\"\nrecovery_time = \"0.1 s\"\n");
  results({"chart", "quickstart.toml", "--repeats", "1"});
  EXPECT_NE(run("Speed against accuracy", "chart.png").find("shown_error"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
