// An armed stand stops whatever happens to the program or to its guard process, and by hand.
#include <gtest/gtest.h>

#include <fstream>

#include "live_session.h"

namespace palpate {
namespace {

using test::has;
using test::Played;
using test::Session;

// A run by the machine's clock that has begun to feel for the surface, 10 mm above the tissue.
class Feeling {
 public:
  Feeling()
      : tissue_("surface = \"-10 mm\"\n"),
        stand_({"mark10", "--tissue", tissue_.path(), "--log", log_}),
        run_({.arguments = {"run", test::project_file("scenarios/device_stand.toml"), "--device",
                            "mark10:" + stand_.port(), "--arm", "--set", "output.figures=false"},
              .folder = folder_.path()}) {}

  // False if the run ended before.
  bool moves() {
    return run_.until([&] { return test::last_in_log(log_, "velocity_m_s") < 0.0; });
  }
  [[nodiscard]] bool stands() const {
    return test::seen([&] { return test::last_in_log(log_, "velocity_m_s") == 0.0; });
  }
  [[nodiscard]] double position() const { return test::last_in_log(log_, "position_m"); }
  // The child of the run that is named as the guard.
  [[nodiscard]] pid_t guard() const {
    const std::string id = std::to_string(run_.id());
    pid_t child = -1;
    std::ifstream("/proc/" + id + "/task/" + id + "/children") >> child;
    return child;
  }
  test::Running& run() { return run_; }
  [[nodiscard]] std::string link() const { return "mark10:" + stand_.port(); }
  [[nodiscard]] const test::fs::path& folder() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
  std::string log_ = (folder_ / "log.csv").string();
  test::ScratchFile tissue_;
  test::LiveEmulator stand_;
  test::Running run_;
};

// m: of a signal that the program sees at once, and of one that the guard sees after 0.1 s of
// silence at 0.5 mm/s, with up to 0.6 s in which this machine runs neither of them.
constexpr double way_after = 0.35e-3;

struct Blow {
  const char* what;
  std::vector<int> to_run;
  std::vector<int> to_guard;
};
void PrintTo(const Blow& blow, std::ostream* out) { *out << blow.what; }

class StandBlow : public testing::TestWithParam<Blow> {};

TEST_P(StandBlow, StopsTheStand) {
  Feeling feeling;
  ASSERT_TRUE(feeling.moves());
  const pid_t guard = feeling.guard();
  ASSERT_GT(guard, 0);
  const double before = feeling.position();
  for (const int signal : GetParam().to_guard) ::kill(guard, signal);
  // A program that has lost its guard stops the stand by itself, which takes it one reading.
  if (!GetParam().to_guard.empty() && !GetParam().to_run.empty()) {
    ASSERT_TRUE(feeling.stands());
  }
  for (const int signal : GetParam().to_run) feeling.run().send(signal);
  EXPECT_TRUE(feeling.stands());
  EXPECT_GT(feeling.position(), before - way_after);
  if (GetParam().to_run.empty()) {
    const test::Ended ended = feeling.run().wait();
    EXPECT_EQ(ended.code, 6) << ended.err;
    EXPECT_TRUE(has(ended.err, "the process that guards the stand has ended")) << ended.err;
  }
  ::kill(guard, SIGKILL);
}

INSTANTIATE_TEST_SUITE_P(
    Blows, StandBlow,
    testing::Values(Blow{"SIGKILL to the run", {SIGKILL}, {}},
                    Blow{"SIGSTOP to the run", {SIGSTOP}, {}}, Blow{"Ctrl-Z", {SIGTSTP}, {}},
                    Blow{"SIGSTOP and SIGKILL to the run", {SIGSTOP, SIGKILL}, {}},
                    Blow{"SIGUSR1 to the run", {SIGUSR1}, {}},
                    Blow{"SIGALRM to the run", {SIGALRM}, {}},
                    Blow{"SIGXCPU to the run", {SIGXCPU}, {}},
                    Blow{"SIGKILL to the guard", {}, {SIGKILL}},
                    Blow{"SIGSTOP to the guard", {}, {SIGSTOP}},
                    Blow{"SIGKILL to the guard, then to the run", {SIGKILL}, {SIGKILL}}));

// If both die at once, nobody is left but the stand's own limit.
TEST(StandStop, GoesAFifthOfAMillimetreAtMostWhenNobodyIsLeft) {
  Feeling feeling;
  ASSERT_TRUE(feeling.moves());
  const pid_t guard = feeling.guard();
  feeling.run().send(SIGSTOP);  // so that it cannot notice the end of its guard
  ::kill(guard, SIGKILL);
  feeling.run().send(SIGKILL);
  const double before = feeling.position();
  EXPECT_TRUE(feeling.stands());
  EXPECT_GT(feeling.position(), before - 0.2e-3 - 2e-5);  // a step, and the stand's resolution
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
  Feeling feeling;
  ASSERT_TRUE(feeling.moves());
  ::kill(feeling.guard(), SIGSTOP);
  feeling.run().send(SIGSTOP);  // nobody stops the stand in this step
  const test::Ended stopped = test::palpate(feeling.folder(), {"device", "stop", feeling.link()});
  EXPECT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_TRUE(has(stopped.err, "stands still")) << stopped.err;
  ::kill(feeling.guard(), SIGKILL);
  const test::Ended recording =
      test::palpate(feeling.folder(), {"device", "stop", "replay:none.csv"});
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
  EXPECT_LT(summary.at("deepest_m").get<double>(), 0.7e-3);  // 40 mN are at 0.5 mm of this tissue
  EXPECT_EQ(summary.at("moving"), false);
}

}  // namespace
}  // namespace palpate
