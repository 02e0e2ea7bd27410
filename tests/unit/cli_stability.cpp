// `palpate stability`: its files, its sentences, its refusals, and that it leaves nothing half.
#include <gtest/gtest.h>

#include "browser.h"
#include "program.h"
#include "record/csv.h"
#include "svg_text.h"

namespace palpate::test {
namespace {

const std::string small =
    "[tissue]\nmaterial = \"skin\"\n"
    "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"20 mm\"] }\n"
    "mesh = { kind = \"kuhn\", cells = [1, 1, 1] }\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";

class StabilityVerb : public testing::Test {
 protected:
  StabilityVerb() { write_file(folder_ / "small.toml", small); }
  [[nodiscard]] Ended map(const std::vector<std::string>& more) const {
    return palpate(folder_.path(), {"stability", "small.toml"}, more);
  }
  TemporaryFolder folder_;
};

TEST_F(StabilityVerb, says_where_nothing_is_stepped) {
  const auto first = [&](const std::string& model) {
    const Ended ended = map({"--force", "--set", "solver.model=" + model});
    const fs::path page = folder_ / "out/small_stability/report.html";
    EXPECT_TRUE(headline_of(page).ends_with(" µs longest safe step of central differences"))
        << model << headline_of(page);
    EXPECT_NE(read_page(page).find("pressed "), std::string::npos) << "what is tested";
    return ended.out.substr(0, ended.out.find('\n'));
  };
  const std::string says = "Nothing is stepped in time here: ",
                    end =
                        "` computes the force at rest, so that no step is too long; the limits are "
                        "those of springs "
                        "with inertia on this body.";
  EXPECT_EQ(first("hertz"), says + "`hertz" + end);
  EXPECT_EQ(first("mass_spring"), says + "`mass_spring` with `quasi_static" + end);
}

TEST_F(StabilityVerb, writes_tables_a_figure_and_sentences) {
  write_file(folder_ / "small.toml",
             small + "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n");
  const Ended ended = map({});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("central differences are stable below"), std::string::npos);
  EXPECT_NE(ended.out.find("measured limits lie within"), std::string::npos);
  EXPECT_NE(ended.out.find(" µs"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find(" us"), std::string::npos) << ended.out;
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"small_stability"}) << "no leftovers";
  const fs::path result = folder_ / "out/small_stability";
  const auto names = names_in(result);
  for (const char* name : {"stability.csv", "failures.csv", "stability.gp"})
    EXPECT_TRUE(names.contains(name)) << name;
  if (names.contains("stability.svg")) {  // gnuplot is there
    EXPECT_EQ(ended.err.find("warning"), std::string::npos) << ended.err;
    EXPECT_EQ(SvgPicture(read_file(result / "stability.svg")).faults(), std::vector<std::string>{});
  }
  EXPECT_TRUE(
      headline_of(result / "report.html").ends_with(" µs longest safe step of central differences"))
      << headline_of(result / "report.html");
  EXPECT_EQ(faults_of_pages(result, {"report.html"}, Scheme::light), std::vector<std::string>{});
  const record::Table limits = record::read_csv(result / "stability.csv");
  EXPECT_EQ(limits.columns,
            (std::vector<std::string>{"model", "volume", "integrator", "damping", "axis", "value",
                                      "limit_us", "theory_us", "ratio", "failure", "note"}));
  EXPECT_GT(limits.rows.size(), 140U);
  const record::Table failures = record::read_csv(result / "failures.csv");
  EXPECT_EQ(failures.columns,
            (std::vector<std::string>{"failure", "model", "integrator", "setting", "setting_unit",
                                      "measure", "measured", "theory", "seen", "note"}));
  // A finished map is not replaced unless that is asked for.
  const Ended again = map({"--set", "finger.radius=8 mm"});
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("holds a finished stability map of other inputs"), std::string::npos)
      << again.err;
  write_file(result / "mark", "old");
  const std::string rows = read_file(result / "stability.csv");
  const std::string failed = read_file(result / "failures.csv");
  EXPECT_EQ(map({"--force"}).code, 0);
  EXPECT_EQ(read_file(result / "stability.csv"), rows) << "the same bits twice";
  EXPECT_EQ(read_file(result / "failures.csv"), failed);
  EXPECT_EQ(read_file(result / "mark"), "old") << "a file that palpate did not write stays";
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"small_stability"}) << "no leftovers";
}

TEST_F(StabilityVerb, refuses_what_has_no_mesh_and_what_is_no_map) {
  const Ended half = map({"--set", "tissue.shape={kind=\"half_space\"}"});
  EXPECT_EQ(half.code, 2);
  EXPECT_NE(half.err.find("a `half_space` has no mesh"), std::string::npos) << half.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  write_file(folder_ / "out/small_stability/notes.txt", "mine");
  const Ended foreign = map({"--force"});
  EXPECT_EQ(foreign.code, 2);
  EXPECT_NE(foreign.err.find("is not a stability map"), std::string::npos) << foreign.err;
  EXPECT_EQ(read_file(folder_ / "out/small_stability/notes.txt"), "mine");
}

// Whether the process catches SIGINT, by what the system says of it.
bool listens(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
  return false;
}

TEST_F(StabilityVerb, an_interrupted_map_leaves_nothing) {
  // The default mesh takes a minute.
  Running running({.arguments = {"stability", "small.toml", "--set",
                                 "tissue.mesh={kind=\"kuhn\",cells=[6,6,6]}"},
                   .folder = folder_.path()});
  ASSERT_TRUE(running.until([&] { return listens(running.id()); }));
  running.send(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_NE(ended.err.find("palpate: interrupted"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace palpate::test
