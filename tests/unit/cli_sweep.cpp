// `palpate sweep`: its files, what it says, its exit codes.
#include <nlohmann/json.hpp>
#include <sstream>
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
  EXPECT_TRUE(merge.err.starts_with("Peak force 0.00")) << merge.err;
  EXPECT_NE(merge.err.find(", not counting viscosity.\n"), std::string::npos) << merge.err;
  EXPECT_NE(merge.err.find("\nModel: hertz in 6 of 6 cases.\nNeglected in 6 of 6 cases"),
            std::string::npos)
      << merge.err;
  EXPECT_TRUE(merge.err.ends_with("out/s_sweep/merged: 6 of 6 cases completed\n")) << merge.err;
  EXPECT_EQ(names_in(folder_ / "out/s_sweep/merged"),
            (std::set<std::string>{"contents.sha256", "merged.json", "report.html",
                                   "response_peak_force_N.csv", "response_peak_force_N.gp",
                                   "response_peak_force_N.svg", "results.csv", "sensitivity.csv",
                                   "sensitivity.gp", "sensitivity.svg"}));
  const fs::path page = folder_ / "out/s_sweep/merged/report.html";
  EXPECT_NE(headline_of(page).find(" N ± "), std::string::npos) << headline_of(page);
  EXPECT_NE(headline_of(page).find(" % (tolerance 5 %), not"), std::string::npos)
      << headline_of(page);
  EXPECT_TRUE(headline_of(page).ends_with(", not counting viscosity")) << headline_of(page);
  for (const char* line : {" % of the variance follows Young&#39;s modulus. Smallest in case ",
                           "(Young&#39;s modulus = ", "<p>Model: hertz in 6 of 6 cases.</p>",
                           "<p>Neglected in 6 of 6 cases", "<p>6 of 6 cases completed, 0 failed",
                           "<p>Tissue: skin; half-space; pressed 0.2 mm by a sphere of radius 11 "
                           "mm.</p>"})
    EXPECT_NE(read_page(page).find(line), std::string::npos) << line;
  const std::string said = read_file(page).substr(read_file(page).find("</span></p>"));
  EXPECT_LT(said.find("Smallest in case "), said.find("<p>Model")) << "the answer of the map";
  const std::string picture = "picture: <a href=\"";
  EXPECT_LT(read_file(page).find(picture + "response_peak_force_N.svg"),
            read_file(page).find(picture + "sensitivity.svg"))
      << "the result comes first";
  const record::Table table =
      record::read_csv((folder_ / "out/s_sweep/merged/results.csv").string());
  EXPECT_EQ(table.rows.size(), 6U);
  // The page's own commands, run as they stand in its folder.
  const std::string commands =
      "palpate sweep plan ../inputs/scenario.toml\npalpate sweep run out/scenario_sweep\npalpate "
      "sweep merge out/scenario_sweep";
  EXPECT_NE(read_file(page).find(commands), std::string::npos);
  for (const std::string& line : split(commands, '\n')) {
    const Ended again = palpate(page.parent_path(), split(line.substr(line.find(' ') + 1), ' '));
    ASSERT_EQ(again.code, 0) << line << "\n" << again.err;
  }
  EXPECT_EQ(read_file(page.parent_path() / "out/scenario_sweep/merged/results.csv"),
            read_file(page.parent_path() / "results.csv"));
  fs::remove_all(page.parent_path() / "out");
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
  EXPECT_EQ(twice.code, 0) << twice.err;
  const Ended other = sweep({"merge", "out/s_sweep", "--show", "contact_radius_mm"});
  EXPECT_EQ(other.code, 2) << "other figures do not replace these unasked";
}

TEST_F(SweepVerb, StatusHasPartTenBehindPartTwo) {
  plan(quick_sweep, {"--set", "sweep.tissue.poisson_ratio=[0.3, 0.35, 0.4, 0.45]"});
  for (const char* part : {"10/10", "2/10", "1/10"})
    ASSERT_EQ(sweep({"run", "out/s_sweep", "--shard", part}).code, 0);
  const std::string out = sweep({"status", "out/s_sweep"}).out;
  const auto place = [&](const std::string& part) { return out.find("\n  " + part); };
  EXPECT_LT(place("1-of-10:"), place("2-of-10:")) << out;
  EXPECT_LT(place("2-of-10:"), place("10-of-10:")) << out;
  EXPECT_LT(place("10-of-10:"), out.size());
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
    if (column == "pressure_map_imbalance" || column == "friction_imbalance") {
      EXPECT_LT(all.find(column), 0) << "a sweep computes no map";
      continue;
    }
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
  EXPECT_TRUE(merge.err.starts_with(
      "warning: sensitivity of `peak_force_N`: 4 of 6 cases have no value, and the indices of a "
      "grid need all; run what is missing, narrow the ranges to where cases complete, or take "
      "`design = \"saltelli\"`\nPeak force "))
      << merge.err;
  EXPECT_TRUE(
      merge.err.ends_with("out/s_sweep/merged: 2 of 6 cases completed, 4 missing (numbers "
                          "1,3-4,6); `palpate sweep run` runs them\n"))
      << merge.err;
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
  const auto plan = nlohmann::json::parse(planned.out);
  EXPECT_EQ(plan.at("cases"), 6);
  EXPECT_EQ(plan.at("there_already"), false);
  EXPECT_EQ(plan.at("row_bytes"), 14400);
  EXPECT_GT(plan.at("seconds"), 0.0);
  EXPECT_GT(plan.at("memory_bytes"), 1e6);
  const Ended run = sweep({"run", "out/s_sweep", "--json"});
  EXPECT_NE(run.out.find("{\"event\":\"progress\",\"done\":6,\"all\":6,\"failed\":0,\"seconds\":"),
            std::string::npos)
      << run.out;
  EXPECT_NE(
      run.out.find("{\"event\":\"end\",\"all\":6,\"completed\":6,\"failed\":0,\"missing\":0}\n"),
      std::string::npos);
  const Ended status = sweep({"status", "out/s_sweep", "--json"});
  EXPECT_TRUE(
      status.out.starts_with("{\"cases\":6,\"completed\":6,\"diverged\":0,\"failed\":0,"
                             "\"missing\":0,"))
      << status.out;
}

// For engines that take any other exit code as a failure, or look for a file.
TEST_F(SweepVerb, FailedCasesAreAccepted) {
  const std::string text =
      "[tissue]\nviscosity = \"none\"\nmesh = { kind = \"mirrored\", cells = [2, 3, 2] }\n"
      "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\nsubsteps = 4\n"
      "allow_unstable = true\n[output]\ninterval = \"12 ms\"\n"
      "[[step]]\nkind = \"creep\"\nload_time = \"0.6 s\"\n"
      "[sweep]\n\"tissue.young_modulus\" = [\"8 kPa\", \"30 kPa\"]\n";
  plan(text);
  const std::string cases = read_file(folder_ / "out/s_sweep/plan.csv");
  const Ended wrong = sweep({"run", "out/s_sweep", "--done", "out/s_sweep/plan.csv"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("plan.csv: exists and was not written by `--done`"), std::string::npos);
  EXPECT_EQ(read_file(folder_ / "out/s_sweep/plan.csv"), cases);
  EXPECT_EQ(sweep({"run", "out/s_sweep", "--done", "done/1"}).code, 7);
  EXPECT_FALSE(fs::exists(folder_ / "done/1"));
  const Ended run = sweep({"run", "out/s_sweep", "--accept-failed", "--done", "done/1"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(read_file(folder_ / "done/1").starts_with("1-of-1 of "));
  EXPECT_EQ(sweep({"retry", "out/s_sweep", "--shard", "1/2", "--accept-failed"}).code, 0);
  EXPECT_EQ(rows(), 2U) << "the other part has the failed case";
  EXPECT_EQ(sweep({"retry", "out/s_sweep", "--shard", "2/2", "--accept-failed"}).code, 0);
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(sweep({"merge", "out/s_sweep"}).code, 7);
  EXPECT_EQ(sweep({"merge", "out/s_sweep", "--accept-failed"}).code, 0);
}

TEST_F(SweepVerb, PartsAreCommands) {
  plan(quick_sweep);
  ASSERT_EQ(sweep({"run", "out/s_sweep", "--shard", "2/3"}).code, 0);
  const Ended parts = sweep({"parts", "out/s_sweep", "--of", "3"});
  EXPECT_EQ(parts.code, 0);
  EXPECT_EQ(std::count(parts.out.begin(), parts.out.end(), '\n'), 2);
  EXPECT_NE(parts.out.find(" --shard 1/3 --jobs 1\n"), std::string::npos) << parts.out;
  const Ended accepting = sweep({"parts", "out/s_sweep", "--of", "3", "--accept-failed"});
  EXPECT_NE(accepting.out.find(" --shard 1/3 --jobs 1 --accept-failed\n"), std::string::npos);
  EXPECT_EQ(sweep({"merge", "out/s_sweep", "--accept-failed"}).code, 7) << "cases are missing";
  ASSERT_EQ(sweep({"slurm", "out/s_sweep", "--accept-failed"}).code, 0);
  EXPECT_NE(read_file(folder_ / "out/s_sweep/job.sbatch").find(":-1}\" --accept-failed &\n"),
            std::string::npos);
  // As JSON, with what each part will take.
  const Ended told = sweep({"parts", "out/s_sweep", "--of", "3", "--json"});
  std::istringstream lines(told.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto part = nlohmann::json::parse(line);
    EXPECT_NE(parts.out.find(part.at("command").get<std::string>() + "\n"), std::string::npos);
    EXPECT_EQ(part.at("cases"), 2);
    EXPECT_GT(part.at("seconds"), 0.0);
    const auto bytes = part.at("memory_bytes").get<double>();
    EXPECT_GT(bytes, 5e6);
    EXPECT_LT(bytes, 1e9);
  }
  EXPECT_EQ(count, 2);
  const Ended all =
      run_program({.arguments = {"-c", parts.out}, .folder = folder_.path(), .program = "bash"});
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_EQ(sweep({"status", "out/s_sweep"}).code, 0);
  EXPECT_EQ(sweep({"parts", "out/s_sweep", "--of", "3"}).out, "");
  const Ended named = sweep({"parts", "out/s_sweep", "--of", "3", "--program", "two\nlines"});
  EXPECT_EQ(named.code, 2) << named.err;
  // A command of two lines is none for GNU parallel.
  std::filesystem::rename(folder_ / "out/s_sweep", folder_ / "two\nlines");
  for (const std::vector<std::string>& call :
       {std::vector<std::string>{"parts", "two\nlines", "--of", "3"}, {"slurm", "two\nlines"}}) {
    const Ended refused = sweep(call);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("has a control character in its name"), std::string::npos);
  }
}

TEST_F(SweepVerb, APlanGrowsByReuse) {
  plan(quick_sweep);
  ASSERT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  std::string larger = quick_sweep;
  larger.replace(larger.find("\"10 kPa\", "), 10, "\"10 kPa\", \"15 kPa\", ");
  const std::string whole = expected(larger);
  write_file(folder_ / "s.toml", larger);
  const Ended grown = sweep({"plan", "s.toml", "--out", "larger", "--reuse", "out/s_sweep"});
  EXPECT_EQ(grown.code, 0) << grown.err;
  EXPECT_NE(grown.err.find("6 of 8 cases taken over from out/s_sweep"), std::string::npos)
      << grown.err;
  const Ended run = sweep({"run", "larger/s_sweep", "--json"});
  EXPECT_NE(run.out.find("\"done\":2,\"all\":2"), std::string::npos) << run.out;
  ASSERT_EQ(sweep({"merge", "larger/s_sweep"}).code, 0);
  EXPECT_EQ(read_file(folder_ / "larger/s_sweep/merged/results.csv"), whole);
}

// What explain says of the cost is of all cases.
TEST_F(SweepVerb, ExplainSaysTheCost) {
  write_file(folder_ / "s.toml", quick_sweep);
  const Ended said = palpate(folder_.path(), {"explain", "s.toml"});
  EXPECT_EQ(said.code, 0);
  EXPECT_NE(said.out.find("\nThe whole takes about "), std::string::npos) << said.out;
  EXPECT_NE(said.out.find(" of processor time: 6 cases of "), std::string::npos) << said.out;
  // What all cases have together comes first, then one of them at length, whichever is asked for.
  EXPECT_TRUE(said.out.starts_with("Models: hertz in 6 of 6.\nErrors of ")) << said.out;
  EXPECT_NE(said.out.find("\ncase 10 kPa_0.3: "), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find("\ncase 0.1 MPa_0.45: "), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("`--case '0.1 MPa_0.45'` shows the last."), std::string::npos);
  const Ended last = palpate(folder_.path(), {"explain", "s.toml", "--case", "0.1 MPa_0.45"});
  EXPECT_NE(last.out.find("\ncase 0.1 MPa_0.45: "), std::string::npos) << last.out;
  const Ended none = palpate(folder_.path(), {"explain", "s.toml", "--case", "0.1 MPa_0.46"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("s.toml: has no case `0.1 MPa_0.46`; did you mean `0.1 MPa_0.45`?"),
            std::string::npos)
      << none.err;
  // Of more cases than `run` takes, the first is explained.
  const Ended many =
      palpate(folder_.path(),
              {"explain", "s.toml", "--set",
               "sweep={\"tissue.young_modulus\"={from=\"1 kPa\",to=\"9 kPa\",points=5000}}"});
  EXPECT_EQ(many.code, 0) << many.err;
  EXPECT_NE(many.out.find(" of processor time: 5000 cases of "), std::string::npos) << many.out;
  EXPECT_LT(many.out.size(), 2 * said.out.size());
}

TEST_F(SweepVerb, SlurmTakesAProgramAndAPrologue) {
  plan(quick_sweep);
  write_file(folder_ / "modules.sh", "module load apptainer");
  const Ended written = sweep({"slurm", "out/s_sweep", "--program", "apptainer exec x.sif palpate",
                               "--prologue", "modules.sh"});
  EXPECT_EQ(written.code, 0) << written.err;
  const std::string job = read_file(folder_ / "out/s_sweep/job.sbatch");
  EXPECT_NE(job.find("\nmodule load apptainer\n"), std::string::npos) << job;
  EXPECT_NE(job.find("\napptainer exec x.sif palpate sweep run \"$folder\""), std::string::npos);
}

// A cluster that says what it allows.
TEST_F(SweepVerb, SlurmKeepsTheLimitsOfTheCluster) {
  plan(quick_sweep);
  write_file(folder_ / "bin/scontrol", "#!/bin/sh\necho 'MaxArraySize            = 3'\n");
  write_file(folder_ / "bin/sinfo", "#!/bin/sh\necho 1:00:00\necho 30:00\n");
  for (const char* name : {"bin/scontrol", "bin/sinfo"})
    fs::permissions(folder_ / name, fs::perms::owner_all);
  const auto slurm = [&](const Words& words) {
    Invocation asked = call({"slurm", "out/s_sweep"});
    asked.arguments.insert(asked.arguments.end(), words.begin(), words.end());
    asked.set = {{"PATH", (folder_ / "bin").string() + ":/usr/bin:/bin"}};
    return run_program(asked);
  };
  const Ended many = slurm({"--chunk", "1"});
  EXPECT_EQ(many.code, 2);
  EXPECT_NE(many.err.find("at most 2 tasks, and `--chunk 1` makes 6; give `--chunk 3`"),
            std::string::npos)
      << many.err;
  EXPECT_EQ(slurm({"--chunk", "3", "--time", "01:00:00"}).code, 0);
  const Ended lengthy = slurm({"--chunk", "3", "--time", "1-00"});
  EXPECT_EQ(lengthy.code, 2);
  EXPECT_NE(lengthy.err.find("give at most `--time 60`"), std::string::npos) << lengthy.err;
}

TEST_F(SweepVerb, SlurmPrintsTheLine) {
  plan(quick_sweep);
  const Ended first = sweep({"slurm", "out/s_sweep", "--chunk", "2", "--time", "00:10:00"});
  const std::string job = "'" + fs::canonical(folder_ / "out/s_sweep/job.sbatch").string() + "'\n";
  EXPECT_EQ(first.code, 0);
  EXPECT_EQ(first.out, "sbatch --array=1-3 " + job);
  ASSERT_EQ(sweep({"run", "out/s_sweep", "--shard", "2/3"}).code, 0);
  EXPECT_EQ(sweep({"slurm", "out/s_sweep", "--chunk", "2"}).out, "sbatch --array=1,3 " + job);
  const auto told =
      nlohmann::json::parse(sweep({"slurm", "out/s_sweep", "--chunk", "2", "--json"}).out);
  EXPECT_EQ(told.at("event"), "submit");
  EXPECT_EQ(told.at("command").get<std::string>() + "\n", "sbatch --array=1,3 " + job);
  EXPECT_EQ(told.at("tasks"), 3);
  EXPECT_EQ(told.at("unfinished"), 2);
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
