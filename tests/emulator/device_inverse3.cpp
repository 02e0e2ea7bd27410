// The arm's link against the emulated service: greeting in both dialects, forces that arrive, and
// what the link does when something goes wrong.
#include "device/inverse3.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "device/link.h"
#include "device/safety.h"
#include "live_emulator.h"
#include "refusal.h"

namespace palpate::device {
namespace {

using test::has;
using test::LiveEmulator;
using test::ScratchFile;

ArmAddress address_of(const LiveEmulator& emulator) {
  return std::get<ArmAddress>(parse_link(emulator.arm_link()));
}

std::vector<std::string> arguments(std::vector<std::string> more = {}) {
  std::vector<std::string> all{"inverse3", "--clock", "virtual"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(Inverse3Link, SaysWhoIsThere) {
  const LiveEmulator emulator(arguments());
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  EXPECT_EQ(arm.identity().firmware, "3.5.0.0");
  EXPECT_EQ(arm.identity().model, "inverse3");
  EXPECT_FALSE(arm.identity().id.empty());
  EXPECT_EQ(arm.identity().dialect, "vector");
  const Sample sample = arm.sample(test::wire_patience);
  ASSERT_EQ(sample.arrival, Arrival::fresh);
  EXPECT_TRUE(sample.position.allFinite());
  EXPECT_TRUE(std::isnan(sample.force));
}

TEST(Inverse3Link, SpeaksTheOlderDialect) {
  const LiveEmulator emulator(arguments({"--service", "3.1"}));
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  EXPECT_EQ(arm.identity().dialect, "values");
  EXPECT_EQ(arm.sample(test::wire_patience).arrival, Arrival::fresh);
}

// A hand at rest is pushed up by the force we send, and by no force that is refused.
TEST(Inverse3Link, SendsForcesThatAreFelt) {
  const ScratchFile log("");
  LiveEmulator emulator(arguments({"--log", log.path()}));
  Clock clock(Clock::Kind::monotonic);
  {
    Inverse3 arm(address_of(emulator), Purpose::command, clock);
    const double start = arm.sample(test::wire_patience).position.z();
    double height = start;
    for (int i = 0; i < 300; ++i) {
      ASSERT_EQ(arm.command_force({0.0, 0.0, 1.0}), Fault::none);
      const Sample sample = arm.sample(test::wire_patience);
      ASSERT_EQ(sample.arrival, Arrival::fresh);
      height = sample.position.z();
    }
    EXPECT_GT(height, start + 1e-3);
    ASSERT_EQ(arm.command_force({0.0, std::nan(""), 1.0}), Fault::none);
    EXPECT_EQ(arm.sample(test::wire_patience).arrival, Arrival::fresh);
  }
  emulator.end();
  const std::string text = log.text();
  EXPECT_TRUE(has(text, R"(""x"":0,""y"":0,""z"":1}}}})")) << text.substr(0, 2000);
  EXPECT_FALSE(has(text, "nan"));
  // The last word is a zero.
  const auto last = text.rfind("set_cursor_force");
  ASSERT_NE(last, std::string::npos);
  EXPECT_TRUE(has(text.substr(last, 60), R"(""x"":0,""y"":0,""z"":0})"));
}

TEST(Inverse3Link, SendsNoForceWhereItOnlyLooks) {
  const LiveEmulator emulator(arguments());
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  EXPECT_EQ(arm.command_force({0.0, 0.0, 0.1}), Fault::refused);
  EXPECT_EQ(arm.command_force(Vec3::Zero()), Fault::none);
  EXPECT_TRUE(arm.stop());
}

TEST(Inverse3Link, GetsOneReplyAMessage) {
  const LiveEmulator emulator(arguments());
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(arm.sample(test::wire_patience).arrival, Arrival::fresh);
  EXPECT_EQ(arm.traffic().sent, arm.traffic().received);
  EXPECT_EQ(arm.traffic().duplicates, 0u);
}

std::string refusal(const std::string& link) {
  Clock clock(Clock::Kind::monotonic);
  return test::refusal<LinkError>([&] { const Link opened(link, Purpose::look, clock); });
}

TEST(Inverse3Link, TellsWhyItCannotBeOpened) {
  std::string port;
  {
    const LiveEmulator emulator(arguments());
    port = emulator.port();
  }
  EXPECT_TRUE(has(refusal("inverse3:127.0.0.1:" + port), "nobody listens on"));
  EXPECT_TRUE(has(refusal("inverse3:no.such.host.invalid:10001"), "is not known"));
  const ScratchFile script("[[fault]]\nat = \"0 s\"\nkind = \"not_ready\"\nduration = \"60 s\"\n");
  const LiveEmulator emulator(arguments({"--fault", script.path()}));
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  EXPECT_EQ(arm.sample(test::wire_patience).fault, Fault::brake);
}

Sample first_of(const std::string& device_table, const std::string& more = {},
                Purpose purpose = Purpose::command) {
  const ScratchFile hand("[device]\n" + device_table);
  const LiveEmulator emulator(arguments({"--hand", hand.path()}));
  Clock clock(Clock::Kind::stepped);
  Link arm(emulator.arm_link() + more, purpose, clock);
  return arm.sample(test::wire_patience);
}
std::string refusal_of(const std::string& device_table, const std::string& more = {}) {
  return test::refusal<LinkError>([&] { (void)first_of(device_table, more); });
}

TEST(Inverse3Link, RefusesToCommandAnArmThatCannotBeTakenAsItIs) {
  EXPECT_TRUE(has(refusal_of("calibrated = false\n"), "is not calibrated; calibrate it"));
  EXPECT_TRUE(has(refusal_of("power_supply = false\n"), "has no power supply"));
  EXPECT_TRUE(has(refusal_of("basis = \"XZY\"\n"), "(the basis `XZY`)"));
  EXPECT_TRUE(has(refusal_of("mount_scale = 2.0\nmount_turn = 1.57\n"),
                  "(a mount that turns, a mount that scales)"));
  EXPECT_TRUE(has(refusal_of("transform_scale = 0.5\n"), "(a transform that scales)"));
  // They are read, with a note.
  EXPECT_EQ(first_of("basis = \"XZY\"\ntransform_scale = 0.5\n", "", Purpose::look).arrival,
            Arrival::fresh);
}

TEST(Inverse3Link, ChoosesOneOfTwoArmsById) {
  const std::string two = "second_id = \"0BAD\"\n";
  EXPECT_TRUE(has(refusal_of(two),
                  "the service has 2 arms, `0BAD`, `049D`; choose one, as "
                  "`inverse3:HOST:PORT/0BAD`"));
  EXPECT_TRUE(has(refusal_of(two, "/0000"), "the service has no arm `0000`, only `0BAD`, `049D`"));
  EXPECT_NE(first_of(two, "/049D").position.z(), 0.0);
  EXPECT_EQ(first_of(two, "/0BAD").position.z(), 0.0);  // the other one lies at the origin
}

TEST(Inverse3Link, ReadsGripsNumericIdsAndBothWordsForTheMode) {
  const std::string odd = "id = \"1234\"\nnumeric_id = true\ngrips = true\nboth_modes = true\n";
  const ScratchFile hand("[device]\n" + odd);
  const LiveEmulator emulator(arguments({"--hand", hand.path()}));
  Clock clock(Clock::Kind::stepped);
  Inverse3 arm(address_of(emulator), Purpose::command, clock);
  EXPECT_EQ(arm.identity().id, "1234");
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(arm.command_force({0.0, 0.0, 0.5}), Fault::none);
    const Sample sample = arm.sample(test::wire_patience);
    ASSERT_EQ(sample.arrival, Arrival::fresh);
    EXPECT_EQ(sample.fault, Fault::none);  // `mode` stays idle, `control_mode` does not
  }
}

struct ArmFault {
  const char* kind;
  const char* more;  // keys of its table
  Fault fault;       // that must be seen at least once
  bool lost;         // whether the link ends
};
void PrintTo(const ArmFault& fault, std::ostream* out) { *out << fault.kind; }
class Inverse3Faults : public testing::TestWithParam<ArmFault> {};

// Of 400 samples the fault falls in the middle. What is fresh is right but for faults that only
// rules of safety can tell (a jump, a velocity), and what follows comes again.
TEST_P(Inverse3Faults, AreSeenAndPassedOver) {
  const ArmFault& expected = GetParam();
  const ScratchFile script("[[fault]]\nat = \"0.1 s\"\nkind = \"" + std::string(expected.kind) +
                           "\"\n" + expected.more);
  const LiveEmulator emulator(arguments({"--fault", script.path()}));
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  bool seen = false;
  bool lost = false;
  int fresh_in_the_end = 0;
  const Vec3 start = arm.sample(test::wire_patience).position;
  for (int i = 0; i < 400 && !lost; ++i) {
    // A reply that is lost is not waited for.
    const bool may_be_lost = expected.fault == Fault::silent && !seen;
    const Sample sample = arm.sample(may_be_lost ? 0.02 : test::wire_patience);
    seen = seen || sample.fault == expected.fault;
    lost = sample.arrival == Arrival::lost;
    if (sample.arrival != Arrival::fresh) continue;
    EXPECT_LT((sample.position - start).norm(), 1e-3) << i;  // a hand that rests
    EXPECT_LT(sample.velocity.norm(), 0.1) << i;
    if (i >= 390) ++fresh_in_the_end;
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(lost, expected.lost);
  if (std::string(expected.kind) == "duplicate") {
    // On a busy machine a late reply is one more, and the last one may still be on its way.
    EXPECT_TRUE(test::seen([&] {
      (void)arm.sample(0.01);
      return arm.traffic().duplicates >= 1U;
    }));
  }
  if (!expected.lost) {
    EXPECT_EQ(fresh_in_the_end, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Inverse3Faults,
    testing::Values(
        ArmFault{"rst", "", Fault::hung_up, true}, ArmFault{"close_1000", "", Fault::hung_up, true},
        ArmFault{"close_1011", "", Fault::hung_up, true},
        ArmFault{"reset", "", Fault::hung_up, true}, ArmFault{"drop", "", Fault::silent, false},
        ArmFault{"late", "value = \"5 ms\"\n", Fault::none, false},
        ArmFault{"duplicate", "", Fault::none, false},
        ArmFault{"reorder", "", Fault::silent, false},
        ArmFault{"invalid_json", "", Fault::garbage, false},
        ArmFault{"partial", "", Fault::garbage, false},
        ArmFault{"missing_field", "", Fault::missing_field, false},
        ArmFault{"wrong_type", "", Fault::missing_field, false},
        ArmFault{"empty", "", Fault::missing_field, false},
        ArmFault{"no_device", "", Fault::missing_field, false},
        ArmFault{"binary", "", Fault::garbage, false}, ArmFault{"nan", "", Fault::garbage, false},
        ArmFault{"huge", "", Fault::not_finite, false},
        ArmFault{"velocity_spike", "", Fault::not_finite, false},
        ArmFault{"id_change", "duration = \"50 ms\"\n", Fault::wrong_device, false},
        ArmFault{"second_device", "duration = \"50 ms\"\n", Fault::none, false},
        ArmFault{"brake", "duration = \"50 ms\"\n", Fault::brake, false},
        ArmFault{"power_off", "duration = \"50 ms\"\n", Fault::brake, false},
        ArmFault{"transform", "", Fault::reframed, true},
        ArmFault{"not_ready", "duration = \"50 ms\"\n", Fault::brake, false}),
    [](const auto& one) { return std::string(one.param.kind); });

// A hand that moves down; what the rules make of a state that stands still, and of one that jumps.
struct Moved {
  int duplicates = 0;
  std::uint64_t jumps = 0;
  int believed = 0;
  double farthest = 0.0;  // m, between two positions that were believed
};
Moved moved_with(const std::string& fault) {
  const ScratchFile hand(
      "[[waypoint]]\nat = \"0.6 s\"\nposition = [\"0 mm\", \"-120 mm\", \"100 mm\"]\n");
  const ScratchFile script("[[fault]]\nat = \"0.3 s\"\nduration = \"30 ms\"\n" + fault);
  const LiveEmulator emulator(arguments({"--hand", hand.path(), "--fault", script.path()}));
  Clock clock(Clock::Kind::stepped);
  Inverse3 arm(address_of(emulator), Purpose::look, clock);
  ArmSafety safety{ArmRules{}};
  Moved moved;
  Vec3 last = arm.sample(test::wire_patience).position;
  for (int i = 0; i < 500; ++i) {
    const Sample sample =
        arm.sample(test::wire_patience);  // asks for the next: the clock steps by a period
    if (sample.arrival == Arrival::duplicate) ++moved.duplicates;
    if (!safety.take(clock.now(), sample)) continue;
    ++moved.believed;
    moved.farthest = std::max(moved.farthest, (sample.position - last).norm());
    last = sample.position;
  }
  moved.jumps = safety.counts().jumps;
  return moved;
}

TEST(Inverse3Link, TellsAFrozenStateAndAJump) {
  const Moved frozen = moved_with("kind = \"freeze\"\n");
  EXPECT_NEAR(frozen.duplicates, 29, 2);  // 30 ms, the first of them a state like any other
  EXPECT_EQ(frozen.believed + frozen.duplicates, 500);
  const Moved jumped = moved_with("kind = \"jump\"\nvalue = \"200 mm\"\n");
  EXPECT_NEAR(static_cast<double>(jumped.jumps), 30.0, 2.0);
  EXPECT_LT(jumped.farthest, 20e-3);  // what the hand went in the meantime, and not 200 mm
}

TEST(Inverse3Link, FallsSilentWithAHalfOpenSocket) {
  const ScratchFile script("[[fault]]\nat = \"0.05 s\"\nkind = \"half_open\"\n");
  const LiveEmulator emulator(arguments({"--fault", script.path()}));
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(address_of(emulator), Purpose::command, clock);
  int fresh = 0;
  while (arm.sample(0.5).arrival == Arrival::fresh) ++fresh;
  EXPECT_GT(fresh, 10);
  for (int i = 0; i < 50; ++i) {  // it never hangs
    static_cast<void>(arm.command_force({0.0, 0.0, 1.0}));
    EXPECT_EQ(arm.sample(1e-3).arrival, Arrival::none);
  }
}

}  // namespace
}  // namespace palpate::device
