// What goes wrong with sweeps: no finished case is lost or counted twice.
#include <sys/syscall.h>

#include <cerrno>
#include <random>

#include "refused_call.h"
#include "sweep_program.h"

namespace palpate::test {
namespace {

using SweepFaults = SweepProgram;

// The cases at hand when the signal comes are finished, and no other is begun.
TEST_F(SweepFaults, SignalsEndItBetweenCases) {
  const std::string text = slow_sweep(20);
  plan(text);
  const std::string whole = expected(text);
  for (const int signal : {SIGTERM, SIGUSR1}) {
    const std::size_t before = rows();
    Running running(call({"run", "out/s_sweep", "--jobs", "1"}));
    ASSERT_TRUE(running.until([&] { return rows() > before; }));
    running.send(signal);
    const Ended ended = running.wait();
    EXPECT_EQ(ended.code, 75) << ended.err;
    EXPECT_NE(ended.err.find("palpate: interrupted; out/s_sweep: "), std::string::npos);
    EXPECT_NE(ended.err.find(" missing; the same command continues from there"), std::string::npos);
    EXPECT_LT(rows(), 20U);
    if (rows() > 11) break;  // there is no time for another signal
  }
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  EXPECT_EQ(rows(), 20U) << "a case was run twice";
  EXPECT_EQ(merged(), whole);
}

TEST_F(SweepFaults, ASecondSignalDoesNotWait) {
  plan(slow_sweep(20));
  Running running(call({"run", "out/s_sweep", "--jobs", "1"}));
  ASSERT_TRUE(running.until([&] { return fs::exists(folder_ / "out/s_sweep/results"); }));
  running.send(SIGINT);
  running.send(SIGTERM);
  EXPECT_EQ(running.wait().code, 75);
}

// Killed at once, or when so many bytes more are on the disk, wherever in a row that is.
TEST_F(SweepFaults, KillsLoseNothing) {
  const std::string text = slow_sweep(24);
  plan(text);
  const std::string whole = expected(text);
  std::mt19937 random(6);
  int in_time = 0;
  for (int kill = 0; kill < 16; ++kill) {
    const std::size_t before = rows();
    const std::uintmax_t size = kill % 4 == 0 ? 0 : bytes() + random() % 300;
    Running running(call({"run", "out/s_sweep", "--jobs", "2"}));
    (void)running.until([&] { return size == 0 || bytes() > size; });
    running.send(SIGKILL);
    in_time += running.wait().signal == SIGKILL ? 1 : 0;
    EXPECT_GE(rows(), before);
  }
  EXPECT_GE(in_time, 6) << "kills came when all was done";
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  EXPECT_EQ(rows(), 24U) << "a case was run twice";
  EXPECT_EQ(merged(), whole);
}

TEST_F(SweepFaults, AFullDiskKeepsFinishedCases) {
  plan(quick_sweep);
  const std::string whole = expected(quick_sweep);
  Invocation tight = call({"run", "out/s_sweep", "--jobs", "1"});
  tight.before = [] {
    const rlimit limit{5000, 5000};  // two rows, about
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
  const Ended ended = run_program(tight);
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(ended.err.starts_with("palpate: out/s_sweep/results/")) << ended.err;
  EXPECT_TRUE(ended.err.ends_with(".rows cannot be written: File too large\n")) << ended.err;
  EXPECT_GE(rows(), 1U);
  EXPECT_LT(rows(), 6U);
  EXPECT_EQ(sweep({"status", "out/s_sweep"}).out.find("corrupt     1"), std::string::npos);
  EXPECT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  EXPECT_EQ(rows(), 6U);
  EXPECT_EQ(merged(), whole);
}

TEST_F(SweepFaults, OnePartIsNotRunTwiceAtOnce) {
  plan(slow_sweep(20));
  Running running(call({"run", "out/s_sweep", "--jobs", "1", "--shard", "1/2"}));
  ASSERT_TRUE(running.until([&] { return fs::exists(folder_ / "out/s_sweep/results"); }));
  running.send(SIGSTOP);  // so that it does not end before the others have begun
  const Ended second = sweep({"run", "out/s_sweep", "--shard", "1/2"});
  EXPECT_EQ(second.code, 8);
  EXPECT_TRUE(second.err.starts_with("out/s_sweep: part 1-of-2 is run already, by process " +
                                     std::to_string(running.id()) + " on "))
      << second.err;
  // Another part is another matter, even one that overlaps.
  const Ended third = sweep({"run", "out/s_sweep", "--shard", "19/20"});
  EXPECT_EQ(third.code, 0) << third.err;
}

// As on some parallel file systems, where flock() is not known.
TEST_F(SweepFaults, WithoutLocksItGoesOn) {
  plan(quick_sweep);
  for (const int error : {ENOSYS, ENOLCK, EOPNOTSUPP}) {
    Invocation run = call({"run", "out/s_sweep", "--shard", "1/2"});
    run.before = [error] { refuse(SYS_flock, error); };
    const Ended ended = run_program(run);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.err.find("its file system has no locks"), std::string::npos) << ended.err;
  }
  EXPECT_EQ(rows(), 3U);
}

TEST_F(SweepFaults, RunsThatOverlapCountOnce) {
  const std::string text = slow_sweep(12);
  plan(text);
  Running first(call({"run", "out/s_sweep", "--jobs", "1", "--shard", "1/1"}));
  Running second(call({"run", "out/s_sweep", "--jobs", "1", "--shard", "1/2"}));
  EXPECT_EQ(first.wait().code, 0);
  EXPECT_EQ(second.wait().code, 0);
  EXPECT_EQ(sweep({"status", "out/s_sweep"}).code, 0);
  EXPECT_EQ(merged(), expected(text));
}

TEST_F(SweepFaults, ACorruptRowIsMissingAndSaid) {
  plan(quick_sweep);
  ASSERT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  const std::string whole = merged();
  const fs::path file = *fs::directory_iterator(folder_ / "out/s_sweep/results");
  std::string text = read_file(file);
  text[text.find("completed")] = 'x';
  write_file(file, text);
  const std::string warning = "warning: out/s_sweep/results/" + file.filename().string() +
                              " has 1 corrupt line; its row counts as missing\n";
  const Ended status = sweep({"status", "out/s_sweep"});
  EXPECT_EQ(status.code, 7);
  EXPECT_NE(status.out.find("missing     1  ("), std::string::npos);
  EXPECT_EQ(status.err, warning);
  const Ended run = sweep({"run", "out/s_sweep"});
  EXPECT_EQ(run.code, 0);
  EXPECT_TRUE(run.err.starts_with(warning)) << run.err;
  EXPECT_EQ(merged(), whole);
  // A part has one line, whatever its number of files.
  const std::string parts = sweep({"status", "out/s_sweep"}).out;
  EXPECT_TRUE(parts.ends_with("files       2\n  1-of-1: 6 rows in 2 files\n")) << parts;
}

// Its rows went into files that nobody finds any more.
TEST_F(SweepFaults, AVanishedFolderIsAnError) {
  plan(slow_sweep(20));
  Running running(call({"run", "out/s_sweep", "--jobs", "1"}));
  const fs::path rows = folder_ / "out/s_sweep/results";
  ASSERT_TRUE(running.until([&] { return fs::exists(rows) && !fs::is_empty(rows); }));
  running.send(SIGSTOP);  // so that cases are left when the folder is gone
  fs::rename(folder_ / "out", folder_ / "moved");
  running.send(SIGCONT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 1) << ended.err;
  EXPECT_NE(ended.err.find("has vanished while its cases ran"), std::string::npos) << ended.err;
}

TEST_F(SweepFaults, APlanOfAnyNumberOfCasesIsRefused) {
  plan(quick_sweep);
  const fs::path file = folder_ / "out/s_sweep/plan.json";
  const std::string text = read_file(file);
  const std::size_t at = text.find("\"cases\": 6");
  ASSERT_NE(at, std::string::npos) << text;
  for (const char* cases : {"1000000000000000000", "-1", "1e300"}) {
    write_file(file, text.substr(0, at) + "\"cases\": " + cases + text.substr(at + 10));
    const Ended ended = sweep({"status", "out/s_sweep"});
    EXPECT_EQ(ended.code, 2) << cases << ": " << ended.err;
  }
}

TEST_F(SweepFaults, AChangedScenarioIsRefused) {
  plan(quick_sweep);
  const fs::path file = folder_ / "out/s_sweep/inputs/scenario.toml";
  write_file(file, read_file(file) + "# later\n");
  for (const char* verb : {"run", "status", "retry", "merge", "slurm"}) {
    const Ended ended = sweep({verb, "out/s_sweep"});
    EXPECT_EQ(ended.code, 2) << verb;
    EXPECT_EQ(ended.err,
              "out/s_sweep/inputs/scenario.toml: has changed since it was planned; put it back, or "
              "plan anew\n");
  }
}

}  // namespace
}  // namespace palpate::test
