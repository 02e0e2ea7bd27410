// `palpate sweep`: its files, what it says, its exit codes.
#include "record/csv.h"
#include "sweep_program.h"

namespace palpate::test {
namespace {

using SweepVerb = SweepProgram;

TEST_F(SweepVerb, PlanRunStatusMerge) {
  plan(quick_sweep);
  const Ended before = sweep({"status", "out/s_sweep"});
  EXPECT_EQ(before.code, 7);
  EXPECT_EQ(before.out,
            "cases       6\ncompleted   0\ndiverged    0\nfailed      0\n"
            "missing     6  (numbers 1-6)\ncorrupt     0\nfiles       0\n");
  const Ended run = sweep({"run", "out/s_sweep"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "out/s_sweep: 6 of 6 cases completed\n");
  const Ended after = sweep({"status", "out/s_sweep"});
  EXPECT_EQ(after.code, 0);
  EXPECT_NE(after.out.find("completed   6\n"), std::string::npos);
  const Ended merge = sweep({"merge", "out/s_sweep"});
  EXPECT_EQ(merge.code, 0);
  EXPECT_EQ(merge.err, "out/s_sweep/merged: 6 of 6 cases completed\n");
  EXPECT_EQ(names_in(folder_ / "out/s_sweep/merged"),
            (std::set<std::string>{"contents.sha256", "merged.json", "report.html",
                                   "response_force_indentation_logarithmic_a_N.csv",
                                   "response_force_indentation_logarithmic_a_N.gp",
                                   "response_force_indentation_logarithmic_a_N.svg",
                                   "response_force_indentation_logarithmic_b_N.csv",
                                   "response_force_indentation_logarithmic_b_N.gp",
                                   "response_force_indentation_logarithmic_b_N.svg",
                                   "response_peak_force_N.csv", "response_peak_force_N.gp",
                                   "response_peak_force_N.svg", "results.csv", "sensitivity.csv",
                                   "sensitivity.gp", "sensitivity.svg"}));
  const record::Table table =
      record::read_csv((folder_ / "out/s_sweep/merged/results.csv").string());
  EXPECT_EQ(table.rows.size(), 6U);
  EXPECT_EQ((std::vector<std::string>(table.columns.begin(), table.columns.begin() + 6)),
            (std::vector<std::string>{"number", "id", "tissue.young_modulus_kPa",
                                      "tissue.poisson_ratio", "outcome", "reason"}));
  EXPECT_EQ(table.rows[4][2], record::Cell(100.0));
  for (const char* column : {"peak_force_N", "force_indentation_power_n",
                             "force_indentation_power_n_std_error", "force_indentation_power_r2"})
    EXPECT_GE(table.find(column), 0) << column;
  // Again: there is nothing left to do.
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  EXPECT_EQ(names_in(folder_ / "out/s_sweep/results").size(), 1U);
  const Ended twice = sweep({"merge", "out/s_sweep"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_EQ(twice.err, "out/s_sweep/merged: is complete already; give `--force` to replace it\n");
}

// A row of a sweep is the case of `palpate run`.
TEST_F(SweepVerb, NumbersAreThoseOfRun) {
  plan(quick_sweep, {"--curves"});
  ASSERT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  ASSERT_EQ(sweep({"merge", "out/s_sweep"}).code, 0);
  ASSERT_EQ(palpate(folder_.path(), {"run", "s.toml", "--out", "one"}).code, 0);
  EXPECT_EQ(read_file(folder_ / "out/s_sweep/merged/force_indentation.csv"),
            read_file(folder_ / "one/s/force_indentation.csv"));
  const record::Table all = record::read_csv((folder_ / "out/s_sweep/merged/results.csv").string());
  const record::Table findings = record::read_csv((folder_ / "one/s/findings.csv").string());
  for (const std::string& column : findings.columns) {
    if (column == "case" || column.find('.') != std::string::npos) continue;
    const int at = all.find(column);
    ASSERT_GE(at, 0) << column;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(all.rows[i][static_cast<std::size_t>(at)],
                findings.rows[i][static_cast<std::size_t>(findings.find(column))])
          << column;
  }
}

TEST_F(SweepVerb, MissingCasesAreRows) {
  plan(quick_sweep);
  EXPECT_EQ(sweep({"run", "out/s_sweep", "--shard", "2/3"}).code, 0);
  const Ended merge = sweep({"merge", "out/s_sweep"});
  EXPECT_EQ(merge.code, 7);
  EXPECT_EQ(merge.err,
            "warning: sensitivity of `peak_force_N`, `force_indentation_logarithmic_a_N`, "
            "`force_indentation_logarithmic_b_N`: 4 of 6 cases have no value, and the indices of a "
            "grid need all; run what is missing, narrow the ranges to where cases complete, "
            "or take `design = \"saltelli\"`\n"
            "out/s_sweep/merged: 2 of 6 cases completed, 4 missing (numbers 1,3-4,6); "
            "`palpate sweep run` runs them\n");
  const record::Table table =
      record::read_csv((folder_ / "out/s_sweep/merged/results.csv").string());
  ASSERT_EQ(table.rows.size(), 6U);
  const auto outcome = static_cast<std::size_t>(table.find("outcome"));
  EXPECT_EQ(table.rows[0][outcome], record::Cell("missing"));
  EXPECT_EQ(table.rows[1][outcome], record::Cell("completed"));
  // What is incomplete is replaced without being asked.
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  EXPECT_EQ(sweep({"merge", "out/s_sweep"}).code, 0);
}

// Steps of 3 ms are too long for the stiffest.
TEST_F(SweepVerb, ACaseThatDivergesIsARowWithItsReason) {
  plan(
      "[tissue]\nviscosity = \"none\"\nmesh = { kind = \"mirrored\", cells = [2, 3, 2] }\n"
      "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\nsubsteps = 4\n"
      "allow_unstable = true\n[output]\ninterval = \"12 ms\"\n"
      "[[step]]\nkind = \"creep\"\nload_time = \"0.6 s\"\n"
      "[sweep]\n\"tissue.young_modulus\" = [\"8 kPa\", \"30 kPa\"]\n");
  const Ended run = sweep({"run", "out/s_sweep"});
  EXPECT_EQ(run.code, 7);
  EXPECT_EQ(run.err, "out/s_sweep: 1 of 2 cases completed, 1 failed\n");
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 7) << "it stays failed";
  EXPECT_EQ(rows(), 2U) << "and is not run again";
  const std::string table = merged();
  EXPECT_EQ(sweep({"retry", "out/s_sweep"}).code, 7);
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(merged(), table);
  const Ended status = sweep({"status", "out/s_sweep"});
  EXPECT_EQ(status.code, 7);
  EXPECT_NE(status.out.find("diverged    1\n"), std::string::npos);
  EXPECT_NE(status.out.find("  1 x "), std::string::npos) << status.out;
}

TEST_F(SweepVerb, ACaseThatCannotBeBuiltIsARowWithItsReason) {
  write_file(folder_ / "bad.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  write_file(folder_ / "bad.ele", "1 4 0\n1 1 3 2 9\n");
  plan(
      "[tissue]\n[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"0.1 mm\"\n[output]\ninterval = \"10 ms\"\n"
      "[sweep]\n\"tissue.mesh\" = [{ kind = \"file\", file = \"bad.node\", unit = \"mm\" }, "
      "{ kind = \"kuhn\", cells = [3, 4, 6] }]\n\"tissue.young_modulus\" = [\"10 kPa\"]\n");
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 7);
  const Ended status = sweep({"status", "out/s_sweep"});
  EXPECT_NE(status.out.find("failed      1\n  1 x "), std::string::npos) << status.out;
  EXPECT_NE(status.out.find("completed   1\n"), std::string::npos) << status.out;
  EXPECT_EQ(merged().find(folder_.path().string()), std::string::npos);
}

TEST_F(SweepVerb, EventsAreJson) {
  write_file(folder_ / "s.toml", quick_sweep);
  const Ended planned = sweep({"plan", "s.toml", "--json"});
  EXPECT_EQ(planned.out,
            "{\"event\":\"plan\",\"folder\":\"out/s_sweep\",\"cases\":\"6\",\"there_already\":"
            "\"false\"}\n");
  const Ended run = sweep({"run", "out/s_sweep", "--json"});
  EXPECT_NE(run.out.find("{\"event\":\"progress\",\"done\":\"6\",\"all\":\"6\",\"failed\":\"0\""),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("{\"event\":\"end\",\"all\":\"6\",\"completed\":\"6\",\"failed\":\"0\","
                         "\"missing\":\"0\"}\n"),
            std::string::npos);
  const Ended status = sweep({"status", "out/s_sweep", "--json"});
  EXPECT_TRUE(
      status.out.starts_with("{\"cases\":6,\"completed\":6,\"diverged\":0,\"failed\":0,"
                             "\"missing\":0,"))
      << status.out;
}

TEST_F(SweepVerb, SlurmPrintsTheLine) {
  plan(quick_sweep);
  const Ended first = sweep({"slurm", "out/s_sweep", "--chunk", "2", "--time", "00:10:00"});
  const std::string job = "'" + fs::canonical(folder_ / "out/s_sweep/job.sbatch").string() + "'\n";
  EXPECT_EQ(first.code, 0);
  EXPECT_EQ(first.out, "sbatch --array=1-3 " + job);
  ASSERT_EQ(sweep({"run", "out/s_sweep", "--shard", "2/3"}).code, 0);
  EXPECT_EQ(sweep({"slurm", "out/s_sweep", "--chunk", "2"}).out, "sbatch --array=1,3 " + job);
  ASSERT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  const Ended none = sweep({"slurm", "out/s_sweep", "--chunk", "2"});
  EXPECT_EQ(none.out, "");
  EXPECT_EQ(none.err, "out/s_sweep: every case has a row; there is nothing to submit\n");
  EXPECT_EQ(sweep({"slurm", "out/s_sweep", "--time", "1;rm"}).code, 2);
}

// Its lines are read by Slurm, and a line feed in a path would be the start of a command.
TEST_F(SweepVerb, SlurmRefusesAFolderWithALineFeed) {
  plan(quick_sweep);
  fs::rename(folder_ / "out", folder_ / "out\ntouch pwned #");
  const Ended refused = sweep({"slurm", "out\ntouch pwned #/s_sweep"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("rename the folder"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace palpate::test
