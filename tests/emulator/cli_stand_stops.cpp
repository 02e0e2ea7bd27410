// An armed stand stops whatever happens to the program or to its guard process, and by hand.
#include <gtest/gtest.h>

#include "held_run.h"

namespace palpate {
namespace {

using test::has;

struct Blow {
  const char* what;
  std::vector<int> to_run;
  std::vector<int> to_guard;
};
void PrintTo(const Blow& blow, std::ostream* out) { *out << blow.what; }

class StandBlow : public testing::TestWithParam<Blow> {};

TEST_P(StandBlow, StopsTheStand) {
  const auto held = test::held_press();
  ASSERT_TRUE(held->moves());
  const pid_t guard = held->guard();
  for (const int signal : GetParam().to_guard) ::kill(guard, signal);
  if (!GetParam().to_guard.empty()) {
    held->go_on();
    // A program that has lost its guard stops the stand by itself.
    EXPECT_TRUE(test::seen([&] { return held->is_stopped(); }));
  }
  for (const int signal : GetParam().to_run) held->send(signal);
  EXPECT_TRUE(test::seen([&] { return held->is_stopped(); }));
  if (GetParam().to_run.empty()) {
    const test::Ended ended = held->run().wait();
    EXPECT_EQ(ended.code, 6) << ended.err;
    EXPECT_TRUE(has(ended.err, "the process that guards the stand has ended")) << ended.err;
  } else {
    held->pass(10);  // 0.2 s of the 1.5 s that are left of the press
  }
  ::kill(guard, SIGKILL);
  const auto summary = held->summary();
  EXPECT_EQ(summary.at("moving"), false);
  EXPECT_GT(summary.at("position_m").get<double>(), -3e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Blows, StandBlow,
    testing::Values(Blow{"SIGKILL to the run", {SIGKILL}, {}}, Blow{"Ctrl-Z", {SIGTSTP}, {}},
                    Blow{"SIGUSR1 to the run", {SIGUSR1}, {}},
                    Blow{"SIGALRM to the run", {SIGALRM}, {}},
                    Blow{"SIGXCPU to the run", {SIGXCPU}, {}},
                    Blow{"SIGKILL to the guard", {}, {SIGKILL}},
                    Blow{"SIGKILL to the guard, then to the run", {SIGKILL}, {SIGKILL}}));

// Silence is one by the machine's clock: who stands still is missed. By the same clock a press at
// 0.1 mm/s has 20 s to be stopped in.
class StandStill : public testing::TestWithParam<bool> {};

TEST_P(StandStill, IsMissed) {
  const bool guard_stops = GetParam();
  const std::string unguarded = "the process that guards the stand has ended";
  for (int i = 0; i < test::runs_by_the_clock; ++i) {
    const test::TemporaryFolder folder;
    const std::string log = (folder / "log.csv").string();
    test::LiveEmulator stand({"mark10", "--log", log, "--tissue",
                              test::project_file("scenarios/emulator/stand_tissue.toml")});
    test::Running run(test::stand_run(folder.path(), stand, "0.1 mm/s"));
    const bool presses = run.until([&] { return test::last_in_log(log, "position_m") < -2.05e-3; });
    if (presses) {
      ::kill(guard_stops ? test::guard_of(run) : run.id(), SIGSTOP);
      EXPECT_TRUE(test::seen([&] { return test::last_in_log(log, "velocity_m_s") == 0.0; }));
    }
    if (!guard_stops) run.send(SIGKILL);
    const test::Ended ended = run.wait();
    // The machine may have kept the run from its link, and it has ended by itself.
    if (!presses || (test::link_was_lost(ended) && !has(ended.err, unguarded))) continue;
    const auto summary = stand.end().at("summary");
    EXPECT_EQ(summary.at("moving"), false);
    EXPECT_GT(summary.at("position_m").get<double>(), -4e-3 + 1e-4);
    EXPECT_EQ(has(ended.err, unguarded), guard_stops) << ended.err;
    EXPECT_EQ(ended.code, guard_stops ? 6 : -1) << ended.err;
    return;
  }
  FAIL() << "the machine stood still in each of " << test::runs_by_the_clock << " runs";
}
INSTANTIATE_TEST_SUITE_P(RunAndGuard, StandStill, testing::Bool());

// Feels for a surface 10 mm below, and is held on its way down.
std::unique_ptr<test::HeldRun> held_feeling() {
  return test::held_run("1.9 s", {}, "surface = \"-10 mm\"\n");
}

// If both die at once, nobody is left but the stand's own limit.
TEST(StandStop, GoesAFifthOfAMillimetreAtMostWhenNobodyIsLeft) {
  const auto held = held_feeling();
  ASSERT_TRUE(held->moves());
  ::kill(held->guard(), SIGKILL);  // while the run stands still and does not notice
  held->run().send(SIGKILL);
  EXPECT_EQ(held->run().wait().signal, SIGKILL);
  const double before = held->position();
  held->pass(30);  // 0.6 s at 0.5 mm/s
  EXPECT_FALSE(held->is_stopped()) << "somebody is left";
  const auto summary = held->summary();
  EXPECT_EQ(summary.at("moving"), false);
  const double after = summary.at("position_m").get<double>();
  EXPECT_LT(after, before);
  EXPECT_GT(after, before - 0.2e-3 - 2e-5);  // a step, and the stand's resolution
}

// A run whose messages nobody reads goes on, and none of them reaches the stand: the port must not
// get the number of a stream that was closed.
class UnheardRun : public testing::TestWithParam<bool> {};

TEST_P(UnheardRun, GoesOn) {
  const bool pipe = GetParam();
  test::TemporaryFolder folder;
  const std::string log = (folder / "log.csv").string();
  test::LiveEmulator stand({"mark10", "--clock", "virtual", "--log", log, "--tissue",
                            test::project_file("scenarios/emulator/stand_tissue.toml")});
  const test::Ended ended = test::run_program(
      {.arguments = {"run", test::project_file("scenarios/device_stand.toml"), "--device",
                     "mark10:" + stand.port(), "--clock", "virtual", "--arm", "--surface", "-2 mm",
                     "--set", "output.figures=false"},
       .folder = folder.path(),
       .before = [pipe] {
         std::array<int, 2> ends{};
         if (::pipe(ends.data()) != 0) ::_exit(126);
         ::close(ends[0]);
         for (const int stream : {1, 2})
           if (pipe)
             ::dup2(ends[1], stream);
           else
             ::close(stream);
         ::close(ends[1]);
         ::signal(SIGPIPE, SIG_DFL);
       }});
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(test::fs::exists(folder.path() / "out/device_stand/run.json"));
  stand.end();
  EXPECT_FALSE(has(test::read_file(log), "unheard"));
  EXPECT_FALSE(has(test::read_file(log), ",in,\"t\"")) << "a letter of a message is a command";
}
INSTANTIATE_TEST_SUITE_P(Streams, UnheardRun, testing::Bool());

TEST(StandStop, IsAVerb) {
  const auto held = held_feeling();
  ASSERT_TRUE(held->moves());
  const test::Ended stopped = test::palpate(held->folder(), {"device", "stop", held->link()});
  EXPECT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_TRUE(has(stopped.err, "stands still")) << stopped.err;
  const test::Ended recording =
      test::palpate(held->folder(), {"device", "stop", "replay:none.csv"});
  EXPECT_EQ(recording.code, 2) << recording.err;
  EXPECT_TRUE(has(recording.err, "wants a device that moves, got `replay:none.csv`"))
      << recording.err;
}

TEST(StandProbe, SaysThatTheStandIsMoving) {
  test::TemporaryFolder folder;
  const test::LiveEmulator stand({"mark10", "--clock", "virtual", "--tissue", "none"});
  {
    const emulator::test::Port port(stand.port());
    port.say("e0060.0d");
  }
  const std::string link = "mark10:" + stand.port();
  const test::Ended probed = test::palpate(folder.path(), {"device", "probe", link});
  EXPECT_EQ(probed.code, 0) << probed.err;
  EXPECT_TRUE(has(probed.out, "is moving down; `palpate device stop " + link + "`")) << probed.out;
}

// A gauge whose sign is turned shows contact as a force that falls: 40 mN of it end the press.
TEST(LiveRun, FeelsContactInBothSigns) {
  const test::ScratchFile file("[[fault]]\nkind = \"sign_flip\"\nat = \"0.7 s\"\n");
  test::TemporaryFolder folder;
  test::LiveEmulator stand({"mark10", "--clock", "virtual", "--tissue",
                            test::project_file("scenarios/emulator/stand_tissue.toml"), "--fault",
                            file.path()});
  const test::Ended ended =
      test::palpate(folder.path(), {"run", test::project_file("scenarios/device_stand.toml"),
                                    "--device", "mark10:" + stand.port(), "--clock", "virtual",
                                    "--arm", "--set", "output.figures=false"});
  EXPECT_EQ(ended.code, 6) << ended.err;
  EXPECT_TRUE(has(ended.err, "the gauge shows compression as negative")) << ended.err;
  const auto summary = stand.end().at("summary");
  // 40 mN are at 0.5 mm of this tissue, or 0.7 mm where it has relaxed, and it is the mean of five
  // readings, 10 um apart, that has to reach them.
  EXPECT_LT(summary.at("deepest_m").get<double>(), 0.7e-3 + 5 * 10e-6);
  EXPECT_EQ(summary.at("moving"), false);
}

}  // namespace
}  // namespace palpate
