// SIGKILL before every system call that changes a file, in verbs that replace a result: the old
// result or the new one stands, whole, and the same call then succeeds.
#include <gtest/gtest.h>

#include "program.h"
#include "result_verbs.h"

namespace palpate::test {
namespace {

using Kills = Hindered;

TEST_P(Kills, LeaveTheOldResultOrTheNewOne) {
  int kills = 0;
  bool killed = true;
  for (int call = 1; killed; call += every() ? 1 : GetParam().stride) {
    const Ended ended = hindered({{"PALPATE_TEST_KILL_BEFORE", std::to_string(call)}});
    killed = ended.signal == SIGKILL;
    if (!killed) {
      EXPECT_EQ(ended.code, 0) << ended.err;
      break;
    }
    ++kills;
    const bool whole = is_old() || is_new();
    // Of two files side by side one may be new: such a pair is refused, and nothing of it is lost.
    const bool pair = std::string(GetParam().name) == "convert" && !whole;
    if (pair) {
      const Ended refused = palpate(folder_.path(), {"convert", "m/m.ele", "--unit", "m"});
      EXPECT_EQ(refused.code, 2) << refused.out;
      EXPECT_TRUE(says(refused, "belongs to other nodes")) << refused.err;
      EXPECT_EQ(read_file(place() / "m.node.replaced"), before_.at("m.node"));
    }
    EXPECT_TRUE(whole || pair) << "before call " << call;
    if (is_old()) continue;
    restore();
  }
  EXPECT_GT(kills, 2) << "calls that change files";
  EXPECT_TRUE(is_new());
}

INSTANTIATE_TEST_SUITE_P(Verbs, Kills, testing::ValuesIn(result_verbs()),
                         [](const auto& one) { return std::string(one.param.name); });

// A signal that can be caught waits for the rename of the file that replaces another.
TEST(TerminatedWrites, LeaveNoTemporaryFile) {
  const TemporaryFolder folder;
  write_file(folder / "n.toml", "old");
  Running running({.arguments = {"new", "press", "n.toml", "--force"},
                   .folder = folder.path(),
                   .set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS}, {"PALPATE_TEST_WAIT_MS", "100"}}});
  ASSERT_TRUE(running.until([&] {
    const std::set<std::string> names = names_in(folder.path());
    return names.rbegin()->starts_with("n.toml.palpate-part");
  }));
  running.send(SIGTERM);
  EXPECT_EQ(running.wait().code, 130);
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"n.toml"});
}

// SIGKILL can come between the name of a whole file and its place: the next call clears up.
TEST(KilledWrites, AreClearedUp) {
  const TemporaryFolder folder;
  write_file(folder / "n.toml", "old");
  const auto call = [&](const char* kill) {
    return run_program(
        {.arguments = {"new", "press", "n.toml", "--force"},
         .folder = folder.path(),
         .set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS}, {"PALPATE_TEST_KILL_BEFORE", kill}}});
  };
  std::size_t most = 0;
  for (const char* kill : {"1", "2", "3", "4", "5", "6"}) {
    (void)call(kill);
    most = std::max(most, names_in(folder.path()).size());
    EXPECT_EQ(call("0").code, 0);
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"n.toml"}) << kill;
  }
  EXPECT_EQ(most, 2U) << "no kill came between";
}

// A chart that was killed at any moment is gone on with by the same call, without `--force`. Every
// seventh moment; all of them with PALPATE_EVERY_FAULT=1.
TEST(KilledCharts, AreGoneOnWith) {
  const TemporaryFolder folder;
  write_file(folder / "s.toml",
             "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\n"
             "to = \"0.1 mm\"\n[output]\nfigures = false\n");
  const Words words{"chart", "s.toml", "--repeats", "1"};
  const int stride = std::getenv("PALPATE_EVERY_FAULT") != nullptr ? 1 : 7;
  for (int call = 1;; call += stride) {
    const Ended ended = run_program({.arguments = words,
                                     .folder = folder.path(),
                                     .set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS},
                                             {"PALPATE_TEST_KILL_BEFORE", std::to_string(call)}}});
    if (ended.signal != SIGKILL) break;
    const Ended again = palpate(folder.path(), words);
    EXPECT_TRUE(again.code == 0 || says(again, "holds a finished chart"))
        << "before call " << call << ": " << again.err;
    EXPECT_TRUE(is_whole(folder / "out/s_chart")) << "before call " << call;
    fs::remove_all(folder / "out");
  }
}

// Both measure; the first that is done is in place, and the other says where its own is.
TEST(TwoCharts, AtOnceLeaveAWholeOne) {
  const TemporaryFolder folder;
  write_file(folder / "s.toml",
             "[tissue]\nmesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n"
             "viscosity = \"kelvin_voigt\"\nretardation_time = \"10 ms\"\n"
             "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\nload_time = \"16 ms\"\n"
             "recovery_time = \"8 ms\"\n[output]\ninterval = \"4 ms\"\nfigures = false\n");
  const Invocation call{.arguments = {"chart", "s.toml", "--repeats", "2"},
                        .folder = folder.path()};
  Running one(call);
  Running other(call);
  for (Running* running : {&one, &other}) {
    const Ended ended = running->wait();
    EXPECT_TRUE(ended.code == 0 || says(ended, "holds a finished chart")) << ended.err;
  }
  EXPECT_TRUE(is_whole(folder / "out/s_chart"));
}

}  // namespace
}  // namespace palpate::test
