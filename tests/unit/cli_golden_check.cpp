// `palpate golden add|check|list`: the pipeline of a user with scenarios of their own.
#include <gtest/gtest.h>

#include "program.h"

namespace palpate::test {
namespace {

// The failing test cases and errors of a JUnit file, as Debian's junitparser reads them.
constexpr const char* print_failures = R"(
import sys
from junitparser import JUnitXml
for suite in JUnitXml.fromfile(sys.argv[1]):
    print(suite.name, suite.tests, suite.failures, suite.errors, suite.skipped)
    for case in suite:
        for result in case.result:
            print(case.classname, case.name, getattr(result, "message", None), sep="|")
)";

class GoldenCheck : public testing::Test {
 protected:
  GoldenCheck() {
    write_file(folder_ / "mine/press.toml",
               "[tissue]\npoisson_ratio = 0.4\n[solver]\nmodel = \"hertz\"\n[[step]]\n"
               "kind = \"indent\"\nto = \"1 mm\"\n[output]\ninterval = \"50 ms\"\nfigures = "
               "false\n[sweep]\n"
               "\"tissue.young_modulus\" = [\"20 kPa\", \"60 kPa\"]\n");
    write_file(folder_ / "mine/soft/scenario.toml",
               "[tissue]\nyoung_modulus = \"5 kPa\"\n[solver]\nmodel = \"hertz\"\n[[step]]\n"
               "kind = \"indent\"\nto = \"1 mm\"\n[output]\ninterval = \"50 ms\"\n");
  }

  [[nodiscard]] Ended golden(const std::vector<std::string>& words) const {
    return palpate(folder_.path(), {"golden"}, words);
  }
  void add_all() const {
    const Ended added = golden({"add", "mine/press.toml", "mine/soft/scenario.toml"});
    ASSERT_EQ(added.code, 0) << added.err;
  }
  void change(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = read_file(folder_ / file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << file;
    write_file(folder_ / file, text.replace(at, from.size(), to));
  }

  TemporaryFolder folder_;
};

TEST_F(GoldenCheck, a_folder_of_own_scenarios_stays_as_it_is) {
  add_all();
  EXPECT_EQ(names_in(folder_ / "mine"),
            (std::set<std::string>{"press.expected", "press.toml", "soft"}));
  EXPECT_EQ(names_in(folder_ / "mine/press.expected"),
            (std::set<std::string>{"findings.csv", "fits.csv", "force_indentation.csv"}));
  const Ended checked = golden({"check", "mine"});
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
  EXPECT_TRUE(says(checked, "2 of 2 scenarios give their baselines")) << checked.err;
  EXPECT_EQ(checked.out, "") << "one line says that all is well";
  EXPECT_EQ(golden({"check", "mine", "--quiet"}).out, "");
  const Ended listed = golden({"list"});
  EXPECT_EQ(listed.out,
            "scenario,expected,files,tolerances\n"
            "mine/press.toml,mine/press.expected,3,\n"
            "mine/soft/scenario.toml,mine/soft/expected,3,\n");
}

TEST_F(GoldenCheck, a_changed_number_is_named_to_people_and_to_build_servers) {
  add_all();
  change("mine/press.toml", "poisson_ratio = 0.4", "poisson_ratio = 0.41");
  change("mine/soft/scenario.toml", "5 kPa", "5.0 kPa");  // the same number
  const Ended checked =
      golden({"check", "mine", "--quiet", "--junit", "junit.xml", "--annotations", "github"});
  EXPECT_EQ(checked.code, 3);
  EXPECT_EQ(checked.out.find("mine/soft"), std::string::npos) << "only what differs";
  EXPECT_NE(checked.out.find("mine/press.toml: DIFFERS in "), std::string::npos) << checked.out;
  const Ended parsed = run_program({.arguments = {"-c", print_failures, "junit.xml"},
                                    .folder = folder_.path(),
                                    .program = "/usr/bin/python3"});
  ASSERT_EQ(parsed.code, 0) << parsed.err;
  // File, case, row and both values of the worst row.
  const std::string wanted =
      "mine/press.toml/force_indentation.csv|contact_force_N|"
      "force_indentation.csv, contact_force_N: DIFFERS in ";
  const std::size_t at = parsed.out.find(wanted);
  ASSERT_NE(at, std::string::npos) << parsed.out;
  const std::string line = parsed.out.substr(at, parsed.out.find('\n', at) - at);
  for (const std::string part : {"worst row ", "case `", ", time_s ", ", got ", ", want "})
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  EXPECT_NE(parsed.out.find("mine/soft/scenario.toml "), std::string::npos) << parsed.out;
  // One annotation, which begins with the curve.
  const std::size_t note = checked.err.find("::error file=mine/press.expected/");
  EXPECT_NE(checked.err.find("force_indentation.csv, force_N: DIFFERS"), std::string::npos)
      << checked.err;
  EXPECT_EQ(checked.err.find("::error", note + 1), std::string::npos) << checked.err;
}

TEST_F(GoldenCheck, tolerances_beside_the_scenario_count) {
  add_all();
  change("mine/soft/scenario.toml", "5 kPa", "5.001 kPa");
  EXPECT_EQ(golden({"check", "mine/soft"}).code, 3);
  write_file(folder_ / "mine/soft/tolerances.toml",
             "[default]\nrel = 1e-3\nabs = 1e-6\n"
             "reason = \"the modulus is known to a thousandth, and residuals are rounding\"\n");
  EXPECT_EQ(golden({"check", "mine/soft/scenario.toml"}).code, 0);
  write_file(folder_ / "mine/soft/tolerances.toml", "[column.force_n]\nrel = 1e-3\n");
  const Ended misspelt = golden({"check", "mine/soft"});
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_TRUE(says(misspelt,
                   "mine/soft/tolerances.toml:1:9: `force_n` is no column of these "
                   "files; did you mean `force_N`?"))
      << misspelt.err;
}

TEST_F(GoldenCheck, a_scenario_that_cannot_run_is_an_error_and_the_others_are_checked) {
  add_all();
  change("mine/press.toml", "1 mm", "1 kPa");
  const Ended checked = golden({"check", "mine", "--junit", "junit.xml"});
  EXPECT_EQ(checked.code, 2);
  EXPECT_TRUE(says(checked, "mine/press.toml: cannot be checked: ")) << checked.err;
  EXPECT_NE(checked.err.find("1 of 2 scenarios give their baselines\n"), std::string::npos)
      << checked.err;
  const Ended parsed = run_program({.arguments = {"-c", print_failures, "junit.xml"},
                                    .folder = folder_.path(),
                                    .program = "/usr/bin/python3"});
  EXPECT_TRUE(parsed.out.starts_with("mine/press.toml 1 0 1 0\nmine/press.toml|run|"))
      << parsed.out << parsed.err;
  const Ended noted = golden({"check", "mine", "--annotations", "github"});
  EXPECT_TRUE(says(noted, "::error file=mine/press.toml,title=")) << noted.err;
}

TEST_F(GoldenCheck, kept_results_are_replaced_only_where_told_and_not_by_machines) {
  add_all();
  change("mine/soft/scenario.toml", "5 kPa", "6 kPa");
  const Ended again = golden({"add", "mine/soft/scenario.toml"});
  EXPECT_EQ(again.code, 2);
  EXPECT_TRUE(says(again, "mine/soft/expected: holds the baseline of mine/soft/scenario.toml"))
      << again.err;
  const Ended machine =
      run_program({.arguments = {"golden", "add", "mine/soft/scenario.toml", "--force"},
                   .folder = folder_.path(),
                   .set = {{"CI", "true"}}});
  EXPECT_EQ(machine.code, 2);
  EXPECT_TRUE(says(machine, "`CI` is set")) << machine.err;
  EXPECT_EQ(golden({"check", "mine"}).code, 3);
  fs::permissions(folder_ / "mine/soft/expected", fs::perms(0700));
  EXPECT_EQ(golden({"add", "mine/soft/scenario.toml", "--force"}).code, 0);
  EXPECT_EQ(golden({"check", "mine"}).code, 0);
  EXPECT_EQ(fs::status(folder_ / "mine/soft/expected").permissions(), fs::perms(0700));
}

TEST_F(GoldenCheck, a_case_that_diverged_is_not_kept) {
  write_file(folder_ / "mine/bad.toml",
             "[tissue]\nviscosity = \"none\"\nmesh = { kind = \"mirrored\", cells = [2, 3, 2] }\n"
             "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n"
             "substeps = 4\nallow_unstable = true\n[output]\ninterval = \"12 ms\"\n"
             "[[step]]\nkind = \"creep\"\nload_time = \"0.6 s\"\n"
             "[sweep]\n\"tissue.young_modulus\" = [\"8 kPa\", \"30 kPa\"]\n");
  const Ended added = golden({"add", "mine/bad.toml"});
  EXPECT_EQ(added.code, 2) << added.err;
  EXPECT_NE(added.err.find("would keep a case that diverged"), std::string::npos) << added.err;
  EXPECT_FALSE(fs::exists(folder_ / "mine/bad.expected"));
}

// Killed at any moment, the kept results are the old ones or the new ones, all of them.
TEST_F(GoldenCheck, kept_results_are_replaced_whole) {
  add_all();
  const auto contents = [&] {
    std::string all;
    for (const std::string& name : names_in(folder_ / "mine/press.expected"))
      all += read_file(folder_ / ("mine/press.expected/" + name));
    return all;
  };
  const std::string old_ones = contents();
  change("mine/press.toml", "1 mm", "2 mm");
  bool ended = false;
  for (int call = 1; !ended && call < 200; ++call) {
    Invocation add{.arguments = {"golden", "add", "mine/press.toml", "--force"},
                   .folder = folder_.path()};
    add.set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS},
               {"PALPATE_TEST_KILL_BEFORE", std::to_string(call)}};
    ended = run_program(add).signal == 0;
    const std::string now = contents();
    if (now == old_ones) continue;
    ASSERT_EQ(golden({"check", "mine/press.toml"}).code, 0) << "killed before call " << call;
  }
  EXPECT_TRUE(ended);
  EXPECT_NE(contents(), old_ones);
}

TEST_F(GoldenCheck, what_is_not_there_is_said) {
  const Ended none = golden({"check", "mine"});
  EXPECT_EQ(none.code, 2);
  EXPECT_TRUE(says(none, "mine: has no scenario with a baseline")) << none.err;
  const Ended one = golden({"check", "mine/press.toml"});
  EXPECT_EQ(one.code, 2);
  EXPECT_TRUE(says(one, "has no baseline; write `palpate golden add mine/press.toml`")) << one.err;
}

}  // namespace
}  // namespace palpate::test
