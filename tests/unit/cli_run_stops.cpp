// Runs that are stopped: finished cases are kept, nothing is half, old results stay.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>

#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

// A quick case, then one of minutes, by one worker. Rows come every few milliseconds.
const std::string slow_given =
    "[tissue]\nmesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"0.005 mm\"\nrate = \"0.005 mm/s\"\n"
    "[output]\ninterval = \"10 ms\"\nfigures = false\nfits = false\n"
    "[sweep]\n\"step.1.to\" = [\"0.005 mm\", \"5 mm\"]\n";

class RunStops : public testing::Test {
 protected:
  RunStops() { write_file(folder_ / "slow.toml", slow_given); }

  [[nodiscard]] Invocation call(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"run", "slow.toml", "--jobs", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {.arguments = arguments, .folder = folder_.path()};
  }

  [[nodiscard]] fs::path partial(const Running& running) const {
    return folder_ / ("out/slow.partial-" + std::to_string(running.id()));
  }

  void wait_for_first_case(Running& running) const {
    ASSERT_TRUE(running.until([&] {
      return fs::exists(partial(running) / "case_001/findings.csv");
    })) << "the first case does not end";
  }

  // A finished result of the same name, known again by a mark.
  void finish_an_old_one() const {
    const Ended ended =
        palpate(folder_.path(), {"run", "slow.toml", "--set", "sweep.step.1.to=[\"0.005 mm\"]"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    write_file(folder_ / "out/slow/mark", "old");
  }

  TemporaryFolder folder_;
};

TEST_F(RunStops, an_interrupted_run_keeps_its_finished_cases) {
  Running running(call({}));
  wait_for_first_case(running);
  running.send(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_NE(ended.err.find("palpate: interrupted; finished cases are kept"), std::string::npos);
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"slow"}) << "no leftovers";
  EXPECT_EQ(names_in(folder_ / "out/slow"),
            (std::set<std::string>{"contents.sha256", "findings.csv", "force_indentation.csv",
                                   "pressure_001.exr", "report.html", "run.json", "scenario.toml"}))
      << "no half files";
  const record::Table findings = record::read_csv(folder_ / "out/slow/findings.csv");
  ASSERT_EQ(findings.rows.size(), 1U);
  EXPECT_EQ(findings.rows[0][0], record::Cell("0.005 mm"));
  EXPECT_NE(read_file(folder_ / "out/slow/run.json").find("\"complete\": false"),
            std::string::npos);
}

// The row of the second case has some ten million steps.
TEST_F(RunStops, an_interrupt_does_not_wait_for_a_row) {
  const std::vector<std::string> press{"--set", "output.interval=1000 s"};
  const std::vector<std::string> creep{
      "--set", "step.1={kind=\"creep\",stress=\"1 kPa\",load_time=\"1 ms\"}",
      "--set", "tissue.shape={kind=\"cuboid\",size=[\"20 mm\",\"20 mm\",\"20 mm\"]}",
      "--set", "sweep={\"step.1.load_time\"=[\"1 ms\",\"1000 s\"]}",
      "--set", "output.interval=1000 s"};
  for (const auto& more : {press, creep}) {
    Running running(call(more));
    wait_for_first_case(running);
    running.send(SIGINT);
    const Ended ended = running.wait();
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_TRUE(says(ended, "finished cases are kept")) << ended.err;
    fs::remove_all(folder_ / "out");
  }
}

// On a slow disk: most maps are omitted, and the same call writes them.
TEST_F(RunStops, an_interrupt_does_not_wait_for_all_maps) {
  write_file(folder_ / "maps.toml",
             "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"
             "[output]\ninterval = \"50 ms\"\nfigures = false\nreport = false\n[sweep]\n"
             "\"tissue.young_modulus\" = { from = \"10 kPa\", to = \"20 kPa\", points = 30 }\n");
  const std::vector<std::string> words{"run", "maps.toml", "--jobs", "1"};
  const auto maps = [&](const fs::path& folder) {
    const std::set<std::string> names =
        fs::exists(folder) ? names_in(folder) : std::set<std::string>();
    return std::count_if(names.begin(), names.end(),
                         [](const std::string& name) { return name.ends_with(".exr"); });
  };
  Running running({.arguments = words,
                   .folder = folder_.path(),
                   .set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS}, {"PALPATE_TEST_WAIT_MS", "20"}}});
  const fs::path partial = folder_ / ("out/maps.partial-" + std::to_string(running.id()));
  ASSERT_TRUE(running.until([&] { return maps(partial) > 0; }));
  running.send(SIGTERM);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_TRUE(says(ended, "pressure maps, meshes and pictures were not written")) << ended.err;
  EXPECT_LT(maps(folder_ / "out/maps"), 30);
  EXPECT_EQ(palpate(folder_.path(), words).code, 0);
  EXPECT_EQ(maps(folder_ / "out/maps"), 30);
}

// Meshes of a finished case, too: the first of a hundred is written, and then few more.
TEST_F(RunStops, an_interrupt_does_not_wait_for_all_meshes) {
  write_file(folder_ / "meshes.toml",
             "[tissue]\nmesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n"
             "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\nto = \"0.1 mm\"\n"
             "rate = \"1 mm/s\"\n[output]\ninterval = \"1 ms\"\nfigures = false\nreport = false\n"
             "tissue = true\ntissue_at = \"rows\"\n");
  const auto meshes = [&](const fs::path& folder) {
    const std::set<std::string> names =
        fs::exists(folder) ? names_in(folder) : std::set<std::string>();
    return std::count_if(names.begin(), names.end(),
                         [](const std::string& name) { return name.ends_with(".vtu"); });
  };
  Running running({.arguments = {"run", "meshes.toml"},
                   .folder = folder_.path(),
                   .set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS}, {"PALPATE_TEST_WAIT_MS", "20"}}});
  const fs::path partial = folder_ / ("out/meshes.partial-" + std::to_string(running.id()));
  ASSERT_TRUE(running.until([&] { return meshes(partial) > 0; }));
  running.send(SIGTERM);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_TRUE(says(ended, "meshes and pictures were not written")) << ended.err;
  EXPECT_LT(meshes(folder_ / "out/meshes"), 50);
  EXPECT_EQ(record::read_csv(folder_ / "out/meshes/force_indentation.csv").rows.size(), 101U);
}

// While one worker presses a long case, the other finishes short ones. What is found out of a
// whole press takes iterations here, which the signal ends as well.
TEST_F(RunStops, an_interrupt_of_a_press_does_not_lose_finished_cases) {
  write_file(folder_ / "coupled.toml",
             "[tissue]\nmesh = { kind = \"kuhn\", cells = [16, 16, 12] }\n"
             "[solver]\nmodel = \"coupled_springs\"\nvolume = \"tetrahedron\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"0.05 mm\"\nrate = \"0.05 mm/s\"\n"
             "[output]\ninterval = \"2 ms\"\nfigures = false\nfits = false\n[sweep]\n"
             "\"step.1.to\" = [\"5 mm\", \"0.01 mm\", \"0.011 mm\", \"0.012 mm\"]\n");
  Running running({.arguments = {"run", "coupled.toml", "--jobs", "2"}, .folder = folder_.path()});
  const fs::path partial = folder_ / ("out/coupled.partial-" + std::to_string(running.id()));
  ASSERT_TRUE(running.until([&] { return fs::exists(partial / "case_003/findings.csv"); }));
  running.send(SIGTERM);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_TRUE(says(ended, "finished cases are kept")) << ended.err;
  EXPECT_GE(record::read_csv(folder_ / "out/coupled/findings.csv").rows.size(), 2U);
}

TEST_F(RunStops, an_incomplete_result_is_run_again_without_force) {
  Running running(call({}));
  wait_for_first_case(running);
  running.send(SIGTERM);
  ASSERT_EQ(running.wait().code, 130);
  const Ended again =
      palpate(folder_.path(), {"run", "slow.toml", "--set", "sweep.step.1.to=[\"0.005 mm\"]"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(read_file(folder_ / "out/slow/run.json").find("\"complete\": true"), std::string::npos);
}

// While figures are drawn: the program that draws is ended, the result stands, and the last line
// says what is missing. A terminal that the user has chosen for gnuplot does not reach it.
class FigureStops : public testing::Test {
 protected:
  FigureStops() {
    write_file(folder_ / "bin/gnuplot", "#!/bin/sh\nprintf '%s' \"${GNUTERM-none}\" > '" +
                                            (folder_ / "terminal").string() +
                                            "'\nexec sleep 100\n");
    fs::permissions(folder_ / "bin/gnuplot", fs::perms(0755));
  }

  [[nodiscard]] Ended stopped(const std::vector<std::string>& arguments) const {
    Running running(
        {.arguments = arguments,
         .folder = folder_.path(),
         .set = {{"PATH", (folder_ / "bin").string() + ":/usr/bin:/bin"}, {"GNUTERM", "dumb"}}});
    EXPECT_TRUE(running.until([&] {
      std::error_code none;
      return fs::file_size(folder_ / "terminal", none) > 0 && !none;  // made, and written
    }));
    running.send(SIGTERM);
    const auto sent = std::chrono::steady_clock::now();
    Ended ended = running.wait();
    // The drawing itself would be ended after 30 s.
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
    return ended;
  }

  TemporaryFolder folder_;
};

TEST_F(FigureStops, of_a_run_are_counted) {
  write_file(folder_ / "press.toml",
             "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n");
  const Ended ended = stopped({"run", "press.toml"});
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_TRUE(ended.err.ends_with(
      "palpate: interrupted; finished cases are kept; 1 figure was not drawn\n"))
      << ended.err;
  EXPECT_EQ(read_file(folder_ / "terminal"), "none");
  EXPECT_TRUE(fs::exists(folder_ / "out/press/contents.sha256"));
}

TEST_F(FigureStops, of_a_chart_are_counted) {
  write_file(folder_ / "s.toml",
             "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\n"
             "to = \"0.1 mm\"\n");
  const Ended ended = stopped({"chart", "s.toml", "--repeats", "1"});
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_TRUE(ended.err.ends_with("out/s_chart: chart.csv and chart.md; 1 figure was not drawn\n"))
      << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/s_chart/contents.sha256"));
}

// Libraries do so where the memory does not suffice.
TEST_F(RunStops, an_abort_has_a_sentence_and_a_code) {
  Running running(call({}));
  wait_for_first_case(running);
  running.send(SIGABRT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended, "palpate: a library ended the program")) << ended.err;
}

// In the first seconds, too: here while it waits for its scenario.
TEST_F(RunStops, a_signal_before_anything_is_built_has_the_same_code) {
  const std::string pipe = (folder_ / "pipe.toml").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    Running running({.arguments = {"run", "pipe.toml"}, .folder = folder_.path()});
    const int writer = ::open(pipe.c_str(), O_WRONLY);  // returns when the program reads
    running.send(signal);
    EXPECT_EQ(running.wait().code, 130);
    ::close(writer);
  }
}

TEST_F(RunStops, an_interrupted_run_without_a_finished_case_leaves_nothing) {
  Running running(call({"--set", "sweep.step.1.to=[\"5 mm\"]"}));
  ASSERT_TRUE(running.until([&] { return fs::exists(partial(running)); }));
  running.send(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_TRUE(says(ended, "palpate: interrupted; nothing was written")) << ended.err;
  EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out"));
}

TEST_F(RunStops, a_part_of_a_run_never_replaces_a_whole_result) {
  finish_an_old_one();
  Running running(call({"--force"}));
  wait_for_first_case(running);
  const fs::path beside = partial(running);
  running.send(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_NE(ended.err.find("out/slow is a finished result and is not replaced"), std::string::npos)
      << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/slow/mark"));
  EXPECT_EQ(record::read_csv(beside / "findings.csv").rows.size(), 1U);
}

// Two runs of one name: who comes second has not been told to replace.
TEST_F(RunStops, a_result_that_another_run_finished_meanwhile_stays) {
  Running running(call({"--set", "sweep.step.1.to=[\"0.005 mm\", \"0.006 mm\", \"0.02 mm\"]"}));
  wait_for_first_case(running);
  const fs::path beside = partial(running);
  running.send(SIGSTOP);  // so that it does not end before the other
  finish_an_old_one();
  running.send(SIGCONT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.err.find(
                "out/slow is a finished result and is not replaced; the result of this run is in " +
                std::string("out/") + beside.filename().string()),
            std::string::npos)
      << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/slow/mark"));
  EXPECT_EQ(record::read_csv(folder_ / "out/slow/findings.csv").rows.size(), 1U);
  EXPECT_EQ(record::read_csv(beside / "findings.csv").rows.size(), 3U);
}

// The first row ends after 1e5 s of simulated time: only the second signal can end this in time.
// They are two, as two of one kind can merge.
TEST_F(RunStops, a_second_signal_does_not_wait) {
  Running running(call({"--set", "output.interval=\"1e6 ms\"", "--set", "step.1.rate=\"1e-6 mm/s\"",
                        "--set", "sweep.step.1.to=[\"1 mm\"]"}));
  ASSERT_TRUE(running.until([&] { return fs::exists(partial(running)); }));
  running.send(SIGINT);
  running.send(SIGTERM);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_EQ(ended.err.find("finished cases are kept"), std::string::npos) << "it waited";
}

TEST_F(RunStops, a_killed_run_keeps_finished_cases_and_the_old_result) {
  finish_an_old_one();
  Running running(call({"--force"}));
  wait_for_first_case(running);
  const fs::path beside = partial(running);
  running.send(SIGKILL);
  EXPECT_EQ(running.wait().signal, SIGKILL);
  EXPECT_TRUE(fs::exists(folder_ / "out/slow/mark"));
  const record::Table rows = record::read_csv(beside / "case_001/force_indentation.csv");
  EXPECT_EQ(rows.rows.size(), 101U);  // 1 s in rows of 10 ms, and the start
  EXPECT_EQ(record::read_csv(beside / "case_001/findings.csv").rows.size(), 1U);
}

}  // namespace
}  // namespace palpate::test
