// The same bits: twice, with any number of workers, from anywhere, and out of the echo.
#include <gtest/gtest.h>

#include <tuple>

#include "every.h"
#include "program.h"
#include "scenario/words.h"

namespace palpate::test {
namespace {

// Every file of two results but run.json, which contains times of the clock, contents.sha256,
// which contains the hash of run.json, and `other`.
void expect_same_files(const fs::path& a, const fs::path& b, const std::string& other = "") {
  ASSERT_EQ(names_in(a), names_in(b));
  EXPECT_GE(names_in(a).size(), 4U);
  for (const std::string& name : names_in(a)) {
    if (name == "run.json" || name == "contents.sha256" || name == other) continue;
    EXPECT_TRUE(read_file(a / name) == read_file(b / name)) << name << " differs";
  }
}

void expect_run(const fs::path& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"run"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Ended ended = palpate(folder, all);
  ASSERT_EQ(ended.code, 0) << ended.err;
}

// The figures too: five tissues through springs, maps, fits and gnuplot.
TEST(Bits, any_number_of_workers) {
  const TemporaryFolder folder;
  const std::string scenario = project_file("scenarios/figure6_force_indentation.toml");
  for (const char* jobs : {"1", "2", "3"})
    expect_run(folder.path(), {scenario, "--jobs", jobs, "--out", std::string("out") + jobs});
  const std::string name = "/figure6_force_indentation";
  const auto files = names_in(folder / ("out1" + name));
  for (const char* file : {"force_indentation.csv", "pressure_005.exr", "report.html",
                           "scenario.toml", "figure_force_indentation.svg"})
    EXPECT_TRUE(files.contains(file)) << file;
  expect_same_files(folder / ("out1" + name), folder / ("out2" + name));
  expect_same_files(folder / ("out1" + name), folder / ("out3" + name));
}

// The echo leads to the same numbers and to itself, for every golden scenario.
TEST(Bits, the_echo_runs_again) {
  for (const std::string& name : names_in(project_file("golden"))) {
    if (name == "meshes") continue;
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    expect_run(folder.path(), {project_file("golden/" + name + "/scenario.toml"), "--out", "a"});
    expect_run(folder.path(), {"a/scenario/scenario.toml", "--out", "b"});
    // The page shows the scenario as it was written.
    expect_same_files(folder / "a/scenario", folder / "b/scenario", "report.html");
  }
}

using Choices = std::tuple<std::string, std::string, std::string>;

class BitsOf : public testing::TestWithParam<Choices> {};

// Integrator, coupling and viscosity, with the memory of a whole programme of steps.
TEST_P(BitsOf, twice_from_different_folders) {
  const auto& [integrator, coupling, viscosity] = GetParam();
  const TemporaryFolder folder;
  fs::create_directories(folder / "deep/er");
  write_file(folder / "press.toml",
             "[tissue]\nmesh = { kind = \"mirrored\", cells = [4, 4, 2] }\n"
             "viscosity = \"" +
                 viscosity +
                 "\"\n"
                 "[contact]\ncoupling = \"" +
                 coupling +
                 "\"\nfriction = 0.3\n"
                 "[solver]\nmodel = \"mass_spring\"\nintegrator = \"" +
                 integrator +
                 "\"\n"
                 "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"20 mm/s\"\n"
                 "[[step]]\nkind = \"hold\"\ntime = \"20 ms\"\n"
                 "[[step]]\nkind = \"retract\"\nrate = \"20 mm/s\"\n"
                 "[output]\ninterval = \"5 ms\"\nfigures = false\n"
                 "[sweep]\n\"tissue.material\" = [\"skin\", \"muscle\"]\n");
  expect_run(folder.path(), {"press.toml", "--jobs", "1"});
  expect_run(folder / "deep/er", {"../../press.toml", "--jobs", "2"});
  expect_same_files(folder / "out/press", folder / "deep/er/out/press");
}

std::string name_of(const testing::TestParamInfo<Choices>& one) {
  const auto& [integrator, coupling, viscosity] = one.param;
  return integrator + "_" + coupling + "_" + viscosity;
}

INSTANTIATE_TEST_SUITE_P(every, BitsOf,
                         testing::Combine(testing::ValuesIn(every(scenario::words::integrators)),
                                          testing::ValuesIn(every(scenario::words::couplings,
                                                                  {"resolved"})),
                                          testing::Values("kelvin_voigt", "standard_linear_solid")),
                         name_of);
// `quasi_static` has no nodal drag.
INSTANTIATE_TEST_SUITE_P(
    drag, BitsOf,
    testing::Combine(testing::ValuesIn(every(scenario::words::integrators, {"quasi_static"})),
                     testing::Values("consistent"), testing::Values("nodal_drag")),
    name_of);

}  // namespace
}  // namespace palpate::test
