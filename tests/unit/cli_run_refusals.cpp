// Runs that must not be, or fail half-way: exit codes, sentences, and what is left untouched.
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/stat.h>

#include <cmath>

#include "base/files.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

const std::string hertz_given =
    "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n"
    "[output]\ninterval = \"10 ms\"\nfigures = false\n";

class RunRefusals : public testing::Test {
 protected:
  RunRefusals() { write_file(folder_ / "press.toml", hertz_given); }

  // A finished result, by the hash of whose manifest it is known again.
  void finish_one() {
    ASSERT_EQ(palpate(folder_.path(), {"run", "press.toml"}).code, 0);
    old_ = manifest();
  }
  [[nodiscard]] std::string manifest() const {
    return sha256(read_file(folder_ / "out/press/run.json"));
  }
  [[nodiscard]] bool old_is_there() const { return manifest() == old_; }

  TemporaryFolder folder_;
  std::string old_;
};

TEST_F(RunRefusals, a_finished_result_stays) {
  finish_one();
  Ended ended = palpate(folder_.path(), {"run", "press.toml", "--set", "finger.radius=8 mm"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "out/press: holds a finished result of other inputs or settings; give `--force` to "
            "replace it, or another `--out`\n");
  write_file(folder_ / "out/press/findings.csv", "edited");
  ended = palpate(folder_.path(), {"run", "press.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "out/press: holds a finished result whose `findings.csv` was changed or removed since; "
            "give `--force` to replace it, or another `--out`\n");
  EXPECT_TRUE(old_is_there());
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"press"});
}

TEST_F(RunRefusals, the_same_run_again_replaces_its_result_and_nothing_else) {
  finish_one();
  write_file(folder_ / "out/press/notes.txt", "mine");
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "--jobs", "1"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_FALSE(old_is_there()) << "run.json has another time";
  EXPECT_EQ(read_file(folder_ / "out/press/notes.txt"), "mine");
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"press"});
}

TEST_F(RunRefusals, a_mesh_beyond_any_memory) {
  for (const char* cells : {"[500,500,500]", "[200,200,200]"}) {
    const Ended ended =
        palpate(folder_.path(), {"run", "press.toml", "--set", "solver.model=mass_spring", "--set",
                                 std::string("tissue.mesh={kind=\"kuhn\",cells=") + cells + "}"});
    EXPECT_EQ(ended.code, 5) << ended.err;
    EXPECT_TRUE(says(ended, "GB; ask for at most 3.5 million")) << ended.err;
  }
}

TEST_F(RunRefusals, force_replaces_what_palpate_wrote_and_nothing_else) {
  finish_one();
  write_file(folder_ / "out/press/notes.txt", "mine");
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "--force"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_FALSE(old_is_there());
  EXPECT_EQ(read_file(folder_ / "out/press/notes.txt"), "mine");
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"press"});
}

TEST_F(RunRefusals, a_folder_that_is_no_result_is_never_replaced) {
  write_file(folder_ / "press/thesis.txt", "mine");
  for (const char* force : {"--quiet", "--force"}) {
    const Ended ended = palpate(folder_.path(), {"run", "press.toml", "--out", ".", force});
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended, "press: is there already and is not a result")) << ended.err;
    EXPECT_EQ(read_file(folder_ / "press/thesis.txt"), "mine");
  }
}

TEST_F(RunRefusals, the_same_name_twice) {
  write_file(folder_ / "other/press.toml", hertz_given);
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "other/press.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "other/press.toml: has the same name as another scenario of this run"))
      << ended.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(RunRefusals, two_scenarios_at_once) {
  write_file(folder_ / "second.toml", hertz_given);
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "second.toml"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(names_in(folder_ / "out"), (std::set<std::string>{"press", "second"}));
}

TEST_F(RunRefusals, one_wrong_scenario_of_two_runs_none) {
  write_file(folder_ / "wrong.toml", "[finger]\nradius = \"3 kPa\"\n" + hertz_given);
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "wrong.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "wrong.toml:2:10: `radius` wants a length, got `3 kPa`")) << ended.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

// A scenario's whole result must not pass for written where a file was cut short. The limit makes
// every write beyond 16 kB fail, as a full disk does, for root too; the map alone has 36 kB.
TEST_F(RunRefusals, a_write_that_fails_keeps_the_old_result) {
  finish_one();
  const Ended ended = run_program(
      {.arguments = {"run", "press.toml", "--force"}, .folder = folder_.path(), .before = [] {
         const rlimit limit{16384, 16384};
         ::setrlimit(RLIMIT_FSIZE, &limit);
       }});
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended, "cannot be written: File too large")) << ended.err;
  EXPECT_TRUE(old_is_there());
}

// A case of more than 50 ms was kept before the map failed, and its folder stays.
TEST_F(RunRefusals, a_write_that_fails_names_the_finished_cases) {
  write_file(folder_ / "slow.toml",
             "[tissue]\nshape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"15 mm\"] }\n"
             "[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"
             "[output]\ninterval = \"1 s\"\n");
  const Ended ended =
      run_program({.arguments = {"run", "slow.toml"}, .folder = folder_.path(), .before = [] {
                     const rlimit limit{16384, 16384};
                     ::setrlimit(RLIMIT_FSIZE, &limit);
                   }});
  EXPECT_EQ(ended.code, 1);
  const std::string words = "; the finished cases are in ";
  const std::size_t at = ended.err.find(words);
  ASSERT_NE(at, std::string::npos) << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / trimmed(ended.err.substr(at + words.size())) / "case_001"))
      << ended.err;
}

// The same on a disk that is really full, where this machine lets us have one.
TEST_F(RunRefusals, a_full_disk_keeps_the_old_result) {
  const std::string disk = (folder_ / "disk").string();
  fs::create_directory(disk);
  // Room for one result (about 250 kB), not for two.
  const std::string script =
      "mount -t tmpfs -o size=400k none '" + disk + "' || exit 99; '" + PALPATE_PROGRAM +
      "' run press.toml --out '" + disk + "' --quiet || exit 98; echo old > '" + disk +
      "/press/mark'; '" + PALPATE_PROGRAM + "' run press.toml --out '" + disk +
      "' --force; code=$?; ls '" + disk + "' '" + disk + "/press'; exit $code";
  const Ended ended = run_program(
      {.arguments = {"-rm", "sh", "-c", script}, .folder = folder_.path(), .program = "unshare"});
  if (ended.code == 127 || ended.code == 99 || says(ended, "unshare"))
    GTEST_SKIP() << "no file system of our own here: " << ended.err;
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended, "No space left on device")) << ended.err;
  EXPECT_NE(ended.out.find("mark\n"), std::string::npos) << ended.out;
}

TEST_F(RunRefusals, a_folder_that_cannot_be_made) {
  write_file(folder_ / "a_file", "");
  const Ended ended = palpate(folder_.path(), {"run", "press.toml", "--out", "a_file/out"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "cannot be a folder, because a part of this path is a file"))
      << ended.err;
  const Ended nowhere = palpate(folder_.path(), {"run", "press.toml", "--out", "/proc/out"});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_TRUE(says(nowhere,
                   "/proc/out: cannot be a folder, because none can be made there; give "
                   "another path"))
      << nowhere.err;
}

TEST_F(RunRefusals, a_scenario_whose_name_is_too_long) {
  for (const char* verb : {"run", "explain"}) {
    const Ended ended = palpate(folder_.path(), {verb, std::string(5000, 'x')});
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended, "File name too long; check the path")) << ended.err.substr(0, 200);
  }
}

TEST_F(RunRefusals, a_folder_whose_name_is_too_long) {
  for (const char* verb : {"run", "chart", "stability"}) {
    const Ended ended =
        palpate(folder_.path(), {verb, "press.toml", "--out", std::string(5000, 'x')});
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended, "is too long for the name of a folder")) << verb;
  }
}

TEST_F(RunRefusals, a_folder_without_permission) {
  fs::create_directory(folder_ / "out");
  ::chmod((folder_ / "out").c_str(), 0555);
  // Root may write everywhere, but for what it gives away for the program that it becomes.
  const Ended ended =
      run_program({.arguments = {"run", "press.toml"}, .folder = folder_.path(), .before = [] {
                     if (::geteuid() == 0 && ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE) != 0)
                       ::_exit(125);
                   }});
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended, "cannot be made: Permission denied")) << ended.err;
  EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out"));
}

const std::string unstable_given =
    "[tissue]\nmaterial = \"skin\"\nmesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n"
    "viscosity = \"none\"\n"  // dashpots slow the growth beyond this programme's 0.6 s
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n"
    "time_step = \"10 ms\"\nsubsteps = 1\n"
    "[[step]]\nkind = \"indent\"\nto = \"3 mm\"\nrate = \"5 mm/s\"\n"
    "[output]\ninterval = \"10 ms\"\nfigures = false\n";

TEST_F(RunRefusals, a_step_above_the_stability_limit) {
  write_file(folder_ / "unstable.toml", unstable_given);
  const Ended ended = palpate(folder_.path(), {"run", "unstable.toml"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended,
                   "unstable.toml:9:12: `substeps` of 1 makes steps of 10 ms, above the "
                   "stability limit"))
      << ended.err;
  EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) << "no leftovers";
}

TEST_F(RunRefusals, divergence_keeps_what_was_stable) {
  write_file(folder_ / "unstable.toml", unstable_given);
  const Ended ended =
      palpate(folder_.path(), {"run", "unstable.toml", "--set", "solver.allow_unstable=true"});
  EXPECT_EQ(ended.code, 4);
  EXPECT_TRUE(says(ended, "unstable, case unstable: ")) << ended.err;
  EXPECT_TRUE(says(ended, "; last stable time ")) << ended.err;
  const std::string page = read_file(folder_ / "out/unstable/report.html");
  EXPECT_NE(page.substr(0, page.find("<section")).find(">Diverged at "), std::string::npos);
  const record::Table findings = record::read_csv(folder_ / "out/unstable/findings.csv");
  const auto finding = [&](const char* name) {
    return findings.rows.at(0).at(static_cast<std::size_t>(findings.find(name)));
  };
  EXPECT_EQ(finding("outcome"), record::Cell("diverged"));
  const double last = std::get<double>(finding("last_stable_time_s"));
  EXPECT_LT(last, 0.6) << "of 0.6 s";
  const record::Table rows = record::read_csv(folder_ / "out/unstable/force_indentation.csv");
  ASSERT_FALSE(rows.rows.empty());
  const auto time = static_cast<std::size_t>(rows.find("time_s"));
  const auto radius = static_cast<std::size_t>(rows.find("tissue_radius_mm"));
  for (const auto& row : rows.rows) {
    EXPECT_LE(std::get<double>(row[time]), last + 1e-12);  // s; rounding of sums of steps
    for (std::size_t i = 1; i < row.size(); ++i)
      EXPECT_TRUE(i == radius || std::isfinite(std::get<double>(row[i]))) << rows.columns[i];
  }
  EXPECT_NEAR(std::get<double>(rows.rows.back()[time]), last, 0.010 + 1e-12);  // one row apart
}

TEST_F(RunRefusals, one_diverged_case_does_not_stop_a_sweep) {
  write_file(folder_ / "unstable.toml",
             unstable_given + "[sweep]\n\"solver.substeps\" = [1, \"auto\"]\n");
  const Ended ended =
      palpate(folder_.path(), {"run", "unstable.toml", "--set", "solver.allow_unstable=true"});
  EXPECT_EQ(ended.code, 4);
  const record::Table findings = record::read_csv(folder_ / "out/unstable/findings.csv");
  const auto outcome = static_cast<std::size_t>(findings.find("outcome"));
  ASSERT_EQ(findings.rows.size(), 2U);
  EXPECT_EQ(findings.rows[0][outcome], record::Cell("diverged"));
  EXPECT_EQ(findings.rows[1][outcome], record::Cell("completed"));
}

// The committed box said to be in other units has another volume than the shape.
TEST_F(RunRefusals, a_mesh_that_does_not_fit) {
  write_file(folder_ / "mesh.toml",
             "[tissue]\nshape = { kind = \"cuboid\" }\nmesh = { kind = \"file\", file = \"" +
                 project_file("golden/meshes/box.node") + "\", unit = \"dm\" }\n" +
                 "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\n");
  const Ended ended = palpate(folder_.path(), {"run", "mesh.toml"});
  EXPECT_EQ(ended.code, 5);
  EXPECT_TRUE(says(ended, "the tetrahedra fill 1.08e-07 m^3, but the body has 0.000108 m^3"))
      << ended.err;
  EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) << "no leftovers";
}

}  // namespace
}  // namespace palpate::test
