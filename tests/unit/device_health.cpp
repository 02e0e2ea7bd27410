// Histograms, counts and their JSON; which message a reply answers; the ring between two threads.
#include "device/health.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "device/clock.h"
#include "device/inverse3.h"
#include "device/tap.h"

namespace palpate::device {
namespace {

TEST(Latency, IsBinnedByPowersOfTwoMicroseconds) {
  LatencyHistogram histogram;
  for (const double time : {0.0, 0.5e-6, 1.5e-6, 3e-6, 1e-3, 1e6}) histogram.add(time);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(-1.0);
  EXPECT_EQ(histogram.count(), 8u);
  EXPECT_EQ(histogram.counts()[0], 4u);
  EXPECT_EQ(histogram.counts()[1], 1u);   // 1 to 2 us
  EXPECT_EQ(histogram.counts()[2], 1u);   // 2 to 4 us
  EXPECT_EQ(histogram.counts()[10], 1u);  // 512 to 1024 us
  EXPECT_EQ(histogram.counts()[LatencyHistogram::bins - 1], 1u);
  EXPECT_EQ(histogram.longest(), 1e6);
  EXPECT_DOUBLE_EQ(histogram.quantile(0.5), 1e-6);
  EXPECT_DOUBLE_EQ(histogram.quantile(0.75), 4e-6);
  EXPECT_EQ(LatencyHistogram{}.quantile(0.5), 0.0);
}

Sample came(Arrival arrival, Fault fault = Fault::none) {
  Sample sample;
  sample.arrival = arrival;
  sample.fault = fault;
  return sample;
}

TEST(HealthCounts, KnowEveryKindOfSample) {
  Health health;
  health.count(0.000, came(Arrival::fresh));
  health.count(0.001, came(Arrival::fresh, Fault::unit_changed));
  health.count(0.002, came(Arrival::none));
  health.count(0.003, came(Arrival::dropped, Fault::garbage));
  health.count(0.004, came(Arrival::duplicate));
  health.count(0.011, came(Arrival::fresh));
  EXPECT_EQ(health.frames, 6u);
  EXPECT_EQ(health.fresh, 3u);
  EXPECT_EQ(health.duplicates, 1u);
  EXPECT_EQ(health.dropped, 1u);
  EXPECT_EQ(health.missing, 1u);
  EXPECT_EQ(health.without_sample(), 3u);
  EXPECT_NEAR(health.longest_gap, 0.010, 1e-12);  // rounding of the difference of two times
}

// The time without samples that ends a run is the longest one, as a rule.
TEST(HealthCounts, TheLongestGapGoesOnToTheEndOfTheRun) {
  Health health;
  health.end_of_samples(5.0);
  EXPECT_EQ(health.longest_gap, 0.0) << "without a frame there is nothing to wait for";
  health.count(1.000, came(Arrival::none));
  health.count(1.010, came(Arrival::fresh));
  EXPECT_NEAR(health.longest_gap, 0.010, 1e-12);  // rounding of the difference of two times
  health.count(1.020, came(Arrival::none));
  health.count(1.100, came(Arrival::lost));
  health.end_of_samples(1.110);
  EXPECT_NEAR(health.longest_gap, 0.100, 1e-12);  // likewise
}

TEST(HealthWarnings, BeginBeyondOnePercentOfTheFrames) {
  Health health;
  EXPECT_TRUE(health_warnings(health).empty());
  for (int i = 0; i < 990; ++i) health.count(1e-3 * i, came(Arrival::fresh));
  for (int i = 0; i < 10; ++i)
    health.count(1.0, came(i % 2 == 0 ? Arrival::none : Arrival::dropped));
  health.rules.stale = 10;
  EXPECT_TRUE(health_warnings(health).empty());
  health.count(1.0, came(Arrival::duplicate));
  health.rules.stale = 21;
  const std::vector<std::string> warnings = health_warnings(health);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_TRUE(warnings[0].starts_with("11 of 1001 frames, 1.1 %, had no new sample"))
      << warnings[0];
  EXPECT_TRUE(warnings[1].starts_with("21 of 1001 frames, 2.1 %, were stale")) << warnings[1];
}

TEST(HealthCounts, KeepTransitionsAndNoRepeats) {
  Health health;
  health.pass({0.0, LinkState::open});
  health.pass({0.1, LinkState::open});
  health.pass({0.2, LinkState::armed});
  health.pass({0.3, LinkState::lost, Trip::link_lost, Fault::hung_up});
  EXPECT_EQ(health.transition_count, 3u);
  for (int i = 0; i < 200; ++i)
    health.pass({1.0, i % 2 == 0 ? LinkState::stale : LinkState::armed});
  health.pass({2.0, LinkState::closed});
  EXPECT_EQ(health.transition_count, 204u);  // more than are kept: counted all the same
  Limits limits;
  const auto json = nlohmann::json::parse(health_json({}, limits, {}, health));
  EXPECT_EQ(json["states"].size(), 64u);
  EXPECT_EQ(json["states"][2]["why"], "the link is lost");
  EXPECT_EQ(json["states"][63]["state"], "closed") << "the last ones are kept as well";
  EXPECT_EQ(json["states"][62]["state"], "armed");
  EXPECT_EQ(json["state_changes"], 204);
}

TEST(HealthCounts, KeepEveryTransitionOfAShortRun) {
  for (const std::size_t count : {1u, 2u, 48u, 49u, 64u, 65u}) {
    Health health;
    for (std::size_t i = 0; i < count; ++i)
      health.pass({static_cast<double>(i), i % 2 == 0 ? LinkState::open : LinkState::stale});
    const std::vector<Transition> kept = health.transitions();
    ASSERT_EQ(kept.size(), std::min<std::size_t>(count, 64)) << count;
    EXPECT_EQ(kept.front().time, 0.0);
    EXPECT_EQ(kept.back().time, static_cast<double>(count - 1));
  }
}

// A reply does not name its message: it is the oldest one's, also if later ones were sent since.
TEST(RepliesOfAnArm, AreChargedToTheirOwnMessages) {
  Unanswered messages;
  EXPECT_EQ(messages.answered(), std::nullopt);
  for (int i = 0; i < 30; ++i) messages.sent(1e-3 * i);
  EXPECT_TRUE(messages.several());
  for (int i = 0; i < 30; ++i) EXPECT_EQ(messages.answered(), 1e-3 * i);
  EXPECT_FALSE(messages.several());
  EXPECT_EQ(messages.given_up(), 0u);
}

// A reply that never comes would make all later ones look late.
TEST(RepliesOfAnArm, LostOnesAreGivenUp) {
  Unanswered messages;
  double sent = 0.0;
  double wrong = 0.0;
  const auto exchange = [&](bool replied) {
    messages.sent(sent += 1e-3);
    if (replied) wrong = sent - messages.answered().value_or(-1.0);
  };
  for (int i = 0; i < 500; ++i) exchange(true);
  EXPECT_EQ(wrong, 0.0);
  for (int i = 0; i < 3; ++i) exchange(false);
  exchange(true);
  EXPECT_NEAR(wrong, 3e-3, 1e-12);
  for (int i = 0; i < 250; ++i) exchange(true);
  EXPECT_EQ(wrong, 0.0);
  EXPECT_EQ(messages.given_up(), 3u);
}

TEST(RepliesOfAnArm, ASlowServiceKeepsItsMessages) {
  Unanswered messages;
  double sent = 0.0;
  for (int i = 0; i < 2; ++i) messages.sent(sent += 1e-3);
  for (int i = 0; i < 500; ++i) {
    messages.sent(sent += 1e-3);
    EXPECT_NEAR(sent - messages.answered().value_or(0.0), 2e-3, 1e-12);
  }
  EXPECT_EQ(messages.given_up(), 0u);
  for (int i = 0; i < 1000; ++i) messages.sent(sent += 1e-3);  // more than there is room for
  EXPECT_GT(messages.given_up(), 700u);
}

TEST(HealthJson, IsCompleteAndHasNoInfinity) {
  Health health;
  health.count(0.0, came(Arrival::dropped, Fault::garbage));
  Traffic traffic;
  traffic.reply.add(5e-4);
  health.rules.clamped = 3;
  Identity identity;
  identity.id = "quote \" and \xff";
  const auto json = nlohmann::json::parse(health_json(identity, Limits{}, traffic, health));
  EXPECT_TRUE(json["limits"]["force_N"].is_null());
  EXPECT_EQ(json["faults"]["bytes came that are no reply"], 1);
  EXPECT_EQ(json["rules"]["force_clamped"], 3);
  EXPECT_EQ(json["reply"]["bins"][0]["below_us"], 512.0);
}

TEST(RingQueue, KeepsOrderAndCountsWhatFindsNoRoom) {
  Ring<int, 4> ring;
  for (int i = 0; i < 6; ++i) EXPECT_EQ(ring.push(i), i < 4);
  EXPECT_EQ(ring.dropped(), 2u);
  int item = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
  }
  EXPECT_FALSE(ring.pop(item));
  EXPECT_TRUE(ring.push(7));
  EXPECT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 7);
}

struct Item {
  std::uint64_t number = 0;
  std::uint64_t again = 0;
};

TEST(RingQueue, LosesNothingBetweenTwoThreads) {
  Ring<Item, 64> ring;
  constexpr std::uint64_t items = 100000;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < items;) {
      if (ring.push({i, ~i})) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  Item item;
  for (std::uint64_t i = 0; i < items;) {
    if (!ring.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(item.number, i);
    ASSERT_EQ(item.again, ~i);
    ++i;
  }
  writer.join();
}

TEST(LoopClock, StepsOnlyWhenToldAndNeverBack) {
  Clock clock(Clock::Kind::stepped);
  EXPECT_EQ(clock.now(), 0.0);
  clock.sleep_until(1.5);
  EXPECT_EQ(clock.now(), 1.5);
  clock.sleep_until(1.0);
  clock.sleep_until(std::numeric_limits<double>::infinity());
  EXPECT_EQ(clock.now(), 1.5);
  Clock machine(Clock::Kind::monotonic);
  const double before = machine.now();
  machine.sleep_until(before + 0.01);
  EXPECT_GE(machine.now(), before + 0.01);
  machine.sleep_until(-1.0);  // past
}

TEST(LoopSystem, GrantsOrSaysWhyNot) {
  for (const std::string& why : {lock_memory(), use_fifo(10)})
    EXPECT_TRUE(why.empty() || why.find("limits.d") != std::string::npos) << why;
  use_ordinary();
  prefault_stack(64 * 1024);
}

}  // namespace
}  // namespace palpate::device
