// Faults of time: device_health.json says of them what the emulator's own log says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "live_session.h"

namespace palpate {
namespace {

using test::Played;
using test::ScratchFile;
using test::Session;

struct LateFault {
  const char* name;
  std::string lines;  // of the script, without `at`
  int code;           // of the session
  int without;        // frames without a new sample that the fault causes; -1: until the end
};

std::string late_name(const testing::TestParamInfo<LateFault>& info) { return info.param.name; }

// The last state is the end of the session, whatever came before; a good one has no trip.
void expect_states(const Played& played) {
  const auto& states = played.health.at("states");
  EXPECT_EQ(states.front().at("state"), "open");
  EXPECT_EQ(states.back().at("state"), "closed");
  bool tripped = false;
  for (const auto& state : states)
    tripped = tripped || state.at("state") == "tripped" || state.at("state") == "lost";
  EXPECT_EQ(tripped, played.ended.code == 6) << states;
}

// Frames that brought no sample, as the samples and as their sum.
int without(const Played& played) {
  const auto& samples = played.health.at("samples");
  const int sum = samples.at("duplicate").get<int>() + samples.at("dropped").get<int>() +
                  samples.at("missing").get<int>();
  EXPECT_EQ(played.health.at("frames_without_sample"), sum);
  return sum;
}

class LateArm : public testing::TestWithParam<LateFault> {};

// A message takes 1 ms of both clocks, so that the longest time without a sample is exact: from the
// last message that was answered well to the next one, or to the end.
TEST_P(LateArm, IsWhatTheEmulatorDid) {
  const LateFault& fault = GetParam();
  const ScratchFile file("[[fault]]\nat = \"0.9 s\"\n" + fault.lines);
  const Played played(
      Session{.link = "inverse3", .scenario = "device_arm", .emulator = {"--fault", file.path()}});
  ASSERT_EQ(played.ended.code, fault.code) << played.ended.err;
  const double began = played.fault_time();
  ASSERT_TRUE(std::isfinite(began));
  int after = 0;  // messages of this session from the fault on
  for (std::size_t i = 0; i < played.log.size(); ++i)
    if (played.log.word(i, "kind") == "in" && played.log.number(i, "time_s") >= began) ++after;
  EXPECT_GT(after, fault.without);
  const double gap = played.health.at("longest_gap_s").get<double>();
  if (fault.without >= 0) {
    EXPECT_EQ(without(played), fault.without);
    EXPECT_NEAR(gap, 1e-3 * (fault.without + 1), 1e-9);
  } else {
    // To the end, but for the messages of the last frames, by which the force falls to zero.
    EXPECT_GE(gap, 0.1 - 1e-9);
    EXPECT_LE(gap, 1e-3 * (after + 1));
  }
  expect_states(played);
}

INSTANTIATE_TEST_SUITE_P(
    Inverse3, LateArm,
    testing::Values(LateFault{"Invalid", "kind = \"invalid_json\"\nreplies = 2\n", 0, 2},
                    LateFault{"Partial", "kind = \"partial\"\nreplies = 5\n", 0, 5},
                    LateFault{"Missing", "kind = \"missing_field\"\nreplies = 20\n", 0, 20},
                    LateFault{"Binary", "kind = \"binary\"\nreplies = 60\n", 0, 60},
                    LateFault{"Frozen", "kind = \"freeze\"\n", 6, -1},
                    LateFault{"OtherDevice", "kind = \"id_change\"\n", 6, -1}),
    late_name);

class LateStand : public testing::TestWithParam<LateFault> {};

// Each request that got no reply cost a reading; a late reply is that of the request before. Of
// three lost replies one is that to a status.
TEST_P(LateStand, IsWhatTheEmulatorDid) {
  const LateFault& fault = GetParam();
  const ScratchFile file("[[fault]]\nat = \"1.2 s\"\n" + fault.lines);
  const Played played(Session{.emulator = {"--fault", file.path()}});
  ASSERT_EQ(played.ended.code, fault.code) << played.ended.err;
  // Readings that the emulator asked and gave, and the longest time between two of them, s.
  double before = std::nan("");
  double longest = 0.0;
  int asked = 0;
  int given = 0;
  for (std::size_t i = 0; i < played.log.size(); ++i) {
    const std::string text = played.log.word(i, "text");
    if (played.log.word(i, "kind") == "in" && text == "n") ++asked;
    const bool reading = text.find(" N") != std::string::npos;
    if (played.log.word(i, "kind") != "out" || !reading) continue;
    ++given;
    const double time = played.log.number(i, "time_s");
    if (std::isfinite(before)) longest = std::max(longest, time - before);
    before = time;
  }
  const auto& traffic = played.health.at("traffic");
  EXPECT_EQ(played.health.at("reply").at("count"), traffic.at("received"));
  EXPECT_GT(asked, 20);
  if (fault.without >= 0) {
    EXPECT_EQ(without(played), fault.without);
    EXPECT_EQ(traffic.at("received"), given - 1) << "of " << asked << "; one is the greeting's";
    EXPECT_EQ(traffic.at("unanswered").get<int>() + traffic.at("received").get<int>(),
              traffic.at("sent").get<int>());
  }
  // A lost reply costs palpate 50 ms, and the emulator's clock one tick.
  EXPECT_GE(played.health.at("longest_gap_s").get<double>(), longest - 0.02);
  if (fault.without > 0) {
    EXPECT_GE(played.health.at("longest_gap_s").get<double>(), 0.05 * fault.without);
  }
  expect_states(played);
}

INSTANTIATE_TEST_SUITE_P(
    Mark10, LateStand,
    testing::Values(LateFault{"Lost", "kind = \"drop\"\n", 0, 1},
                    LateFault{"LostThrice", "kind = \"drop\"\nreplies = 3\n", 0, 2},
                    LateFault{"Stall", "kind = \"stall\"\nduration = \"70 ms\"\n", 0, -1},
                    LateFault{"Unplugged", "kind = \"unplug\"\n", 6, -1}),
    late_name);

// Replies that a stall holds back for longer than palpate waits are those of their own requests.
TEST(LateStand, ChargesLateRepliesToTheirOwnRequests) {
  const ScratchFile file("[[fault]]\nkind = \"stall\"\nat = \"1.2 s\"\nduration = \"70 ms\"\n");
  const Played played(Session{.emulator = {"--fault", file.path()}});
  ASSERT_EQ(played.ended.code, 0) << played.ended.err;
  const auto& traffic = played.health.at("traffic");
  EXPECT_GE(traffic.at("late").get<int>(), 1) << traffic;
  EXPECT_EQ(traffic.at("unanswered"), 0) << "all came";
  EXPECT_GE(played.health.at("reply").at("longest_s").get<double>(), 0.07);
}

// By the machine's clock: a reply that comes 30 ms late took 30 ms, however many messages were sent
// since.
TEST(LateArm, ChargesALateReplyToItsOwnMessage) {
  const ScratchFile file(
      "[[fault]]\nkind = \"late\"\nafter_messages = 300\nvalue = \"30 ms\"\nreplies = 1\n");
  for (int i = 0; i < test::runs_by_the_clock; ++i) {
    const Played played(Session{.link = "inverse3",
                                .scenario = "device_arm",
                                .clock = "real",
                                .emulator = {"--fault", file.path()},
                                .options = {"--arm", "--seconds", "1"}});
    if (test::link_was_lost(played.ended)) continue;
    EXPECT_EQ(played.ended.code, 0) << played.ended.err;
    EXPECT_GE(played.health.at("reply").at("longest_s").get<double>(), 0.03);
    EXPECT_GT(played.health.at("traffic").at("late").get<int>(), 0);
    EXPECT_GE(played.health.at("longest_gap_s").get<double>(), 0.028);
    return;
  }
  FAIL() << "the machine stood still in each of " << test::runs_by_the_clock << " runs";
}

}  // namespace
}  // namespace palpate
