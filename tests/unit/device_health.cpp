// Histograms, counts and their JSON; the ring between two threads.
#include "device/health.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "device/clock.h"
#include "device/realtime.h"
#include "device/ring.h"

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
  EXPECT_DOUBLE_EQ(health.longest_gap, 0.010);
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
  EXPECT_EQ(health.transition_count, 203u);  // more than are kept: counted all the same
  Limits limits;
  const auto json = nlohmann::json::parse(health_json({}, limits, {}, health));
  EXPECT_EQ(json["states"].size(), 64u);
  EXPECT_EQ(json["states"][2]["why"], "the link is lost");
  EXPECT_EQ(json["state_changes"], 203);
}

TEST(HealthJson, IsCompleteAndHasNoInfinity) {
  Health health;
  health.count(0.0, came(Arrival::dropped, Fault::garbage));
  health.reply.add(5e-4);
  health.rules.clamped = 3;
  Identity identity;
  identity.id = "quote \" and \xff";
  const auto json = nlohmann::json::parse(health_json(identity, Limits{}, {}, health));
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
