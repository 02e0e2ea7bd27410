// Nothing is allocated once a link is open: a loop that asks and commands a thousand times takes
// no memory.
#include <gtest/gtest.h>

#include <string>

#include "counted_memory.h"
#include "device/health.h"
#include "device/link.h"
#include "device/safety.h"
#include "device/tap.h"
#include "live_emulator.h"

namespace palpate::device {
namespace {

TEST(LinkAllocations, AreNoneInTheArmsLoop) {
  const test::LiveEmulator emulator({"inverse3", "--clock", "virtual"});
  Clock clock(Clock::Kind::stepped);
  Link link(emulator.arm_link(), Purpose::command, clock);
  ArmSafety safety{ArmRules{}};
  Health health;
  static Ring<Sample, 4096> ring;
  const std::size_t before = test::blocks_taken;
  int fresh = 0;
  for (int i = 0; i < 1000; ++i) {
    const Sample sample = link.sample(test::wire_patience);
    clock.sleep_until(clock.now() + 1e-3);
    health.count(clock.now(), sample);
    if (safety.take(clock.now(), sample)) ++fresh;
    if (i == 10) safety.arm(clock.now(), -1.0);
    ASSERT_EQ(link.command_force(safety.allow(clock.now(), {0.0, 0.0, 0.5})), Fault::none);
    ring.push(sample);
  }
  EXPECT_EQ(test::blocks_taken - before, 0U);
  EXPECT_EQ(fresh, 1000);
  EXPECT_GT(safety.sent().z(), 0.4);
}

// Events that are many, long, broken, and of a port that closes in the end.
TEST(LinkAllocations, AreNoneByEvents) {
  const test::ScratchFile script(
      "[[fault]]\nkind = \"event_busy\"\nat = \"0.05 s\"\n"
      "[[fault]]\nkind = \"event_huge\"\nat = \"0.1 s\"\n"
      "[[fault]]\nkind = \"event_garbage\"\nat = \"0.15 s\"\n"
      "[[fault]]\nkind = \"event_stall\"\nat = \"0.25 s\"\n"
      "[[fault]]\nkind = \"events_close\"\nat = \"1.5 s\"\n");
  const test::LiveEmulator emulator({"inverse3", "--clock", "virtual", "--fault", script.path()});
  Clock clock(Clock::Kind::stepped);
  Link link(emulator.arm_link(), Purpose::command, clock);
  const std::size_t before = test::blocks_taken;
  int fresh = 0;
  bool stalled = false;
  for (int i = 0; i < 1700; ++i) {
    const Sample sample = link.sample(test::wire_patience);
    if (sample.arrival == Arrival::fresh) ++fresh;
    stalled = stalled || sample.fault == Fault::stalled;
    static_cast<void>(link.command_force({0.0, 0.0, 0.5}));
  }
  EXPECT_EQ(test::blocks_taken - before, 0U);
  EXPECT_EQ(fresh, 1700);
  EXPECT_TRUE(stalled);
  EXPECT_EQ(link.traffic().events.port, Events::Port::lost);
}

TEST(LinkAllocations, AreNoneInTheStandsLoop) {
  const test::LiveEmulator emulator({"mark10", "--clock", "virtual", "--tissue", "none"});
  Clock clock(Clock::Kind::stepped);
  Link link("mark10:" + emulator.port(), Purpose::command, clock);
  ASSERT_EQ(link.set_travel_limits(-5e-3, 5e-3), Fault::none);
  const std::size_t before = test::blocks_taken;
  int fresh = 0;
  for (int i = 0; i < 100; ++i) {
    if (i == 10) {
      EXPECT_EQ(link.command_motion({Motion::Act::down, 1e-3}), Fault::none);
    }
    if (i == 50) {
      EXPECT_TRUE(link.stop());
    }
    if (link.sample(test::wire_patience).arrival == Arrival::fresh) ++fresh;
  }
  EXPECT_EQ(test::blocks_taken - before, 0U);
  EXPECT_EQ(fresh, 100);
}

TEST(LinkAllocations, AreNoneInAGaugesLoop) {
  const test::ScratchFile settings(
      "pattern = \"{force} {force_unit}\"\nbaud = 115200\npoll = \"?\\r\"\n");
  const test::ScratchFile gauge("[gauge]\nstyle = \"mark10\"\n");
  const test::LiveEmulator emulator(
      {"gauge", "--clock", "virtual", "--baud", "115200", "--gauge", gauge.path()});
  Clock clock(Clock::Kind::stepped);
  Link link("serial:" + emulator.port() + "," + settings.path(), Purpose::look, clock);
  const std::size_t before = test::blocks_taken;
  int fresh = 0;
  for (int i = 0; i < 100; ++i)
    if (link.sample(test::wire_patience).arrival == Arrival::fresh) ++fresh;
  EXPECT_EQ(test::blocks_taken - before, 0U);
  EXPECT_EQ(fresh, 100);
}

}  // namespace
}  // namespace palpate::device
