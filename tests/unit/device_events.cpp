// An arm's events: which are obeyed, about whom, and what any other bytes come to.
#include "device/inverse3_protocol.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "device/health.h"

namespace palpate::device {
namespace {

std::string safety(const std::string& type, const std::string& level,
                   const std::string& device = R"("device_id":"049D",)") {
  return R"({"name":"device-safety-triggered","category":"device","level":")" + level +
         R"(","data":{"device_family":"inverse",)" + device + R"("safety_type":")" + type +
         R"("},"message":"Something happened"})";
}

Event read(const std::string& text) { return inverse3::parse_event(text, "049D"); }

// docs.haply.co, Events & Monitoring, 3.5: names, sub-types and their levels.
TEST(ArmEvents, OfTheManualAreKnown) {
  EXPECT_EQ(read(safety("ebrake_triggered", "error")), Event::brake);
  EXPECT_EQ(read(safety("ebrake_released", "notice")), Event::released);
  EXPECT_EQ(read(safety("fod_stage_changed", "warning")), Event::stage_raised);
  EXPECT_EQ(read(safety("fod_stage_changed", "info")), Event::stage_lowered);
  EXPECT_EQ(read(safety("stall_detected", "warning")), Event::stall);
  EXPECT_EQ(read(safety("stability_ceiling", "warning")), Event::ceiling);
  EXPECT_EQ(read(R"({"name":"device-disconnected","data":{"device_id":"049D"}})"),
            Event::disconnected);
  EXPECT_EQ(read(R"({"data":{"device_id":"049D"},"name":"device-busy"})"), Event::busy);
  EXPECT_EQ(read(R"({"name":"system-rate-report","data":{"device_id":"049D"}})"), Event::other);
  EXPECT_EQ(read("{}"), Event::other);
}

TEST(ArmEvents, OfSafetyThatNobodyKnowsAreObeyedUnlessTheyAreNotices) {
  EXPECT_EQ(read(safety("thermal", "warning")), Event::safety);
  EXPECT_EQ(read(safety("thermal", "critical")), Event::safety);
  EXPECT_EQ(read(safety("thermal", "")), Event::safety);
  EXPECT_EQ(read(safety("thermal", "info")), Event::notice);
  EXPECT_EQ(read(R"({"name":"device-safety-triggered"})"), Event::safety);
  EXPECT_EQ(read(R"({"name":"device-safety-triggered","data":[1]})"), Event::safety);
}

TEST(ArmEvents, OfAnotherDeviceAreNotOurs) {
  EXPECT_EQ(read(safety("ebrake_triggered", "error", R"("device_id":"0BAD",)")),
            Event::other_device);
  EXPECT_EQ(read(R"({"name":"device-disconnected","data":{"device_id":"049"}})"),
            Event::other_device);
  EXPECT_EQ(read(R"({"name":"device-busy","data":{"device_id":"0BAD"}})"), Event::other_device);
  // Who names nobody may mean us.
  EXPECT_EQ(read(safety("ebrake_triggered", "error", "")), Event::brake);
  EXPECT_EQ(read(safety("ebrake_triggered", "error", R"("device_id":49,)")), Event::brake);
}

TEST(ArmEvents, BrokenOnesAreGarbage) {
  const std::string whole = safety("ebrake_triggered", "error");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(read(whole.substr(0, size)), Event::garbage) << size;
  EXPECT_EQ(read(whole + "}"), Event::garbage);
  EXPECT_EQ(read("[" + whole + "]"), Event::garbage);
  EXPECT_EQ(read(R"("device-disconnected")"), Event::garbage);
  EXPECT_EQ(read(std::string(1000, '{')), Event::garbage);
}

TEST(ArmEvents, ThatAreObeyedAndThatAreTold) {
  std::set<std::string_view> words;
  for (std::size_t i = 0; i < event_kinds; ++i) {
    const auto event = static_cast<Event>(i);
    words.insert(event_text(event));
    const bool told = event == Event::other || event == Event::garbage ||
                      event == Event::other_device || event == Event::released ||
                      event == Event::stage_lowered || event == Event::notice ||
                      event == Event::busy;
    EXPECT_EQ(fault_of(event) == Fault::none, told) << event_text(event);
  }
  EXPECT_EQ(words.size(), event_kinds);
  EXPECT_FALSE(words.contains("unknown"));
  EXPECT_EQ(fault_of(Event::disconnected), Fault::hung_up);
}

TEST(ArmEvents, AreSaidInSentencesAndInTheHealthOfALink) {
  Traffic traffic;
  EXPECT_TRUE(event_sentences(traffic.events).empty());
  EXPECT_EQ(health_json({}, {}, traffic, {}).find("\"events\""), std::string::npos);
  traffic.events.port = Events::Port::lost;
  traffic.events.counts[static_cast<std::size_t>(Event::busy)] = 1;
  traffic.events.counts[static_cast<std::size_t>(Event::stall)] = 2;
  traffic.events.counts[static_cast<std::size_t>(Event::other)] = 7;
  const auto sentences = event_sentences(traffic.events);
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_NE(sentences[0].find("port closed"), std::string::npos);
  EXPECT_EQ(sentences[1], "the service reported `stall_detected`, 2 times");
  EXPECT_NE(sentences[2].find("another session"), std::string::npos);
  const std::string json = health_json({}, {}, traffic, {});
  EXPECT_NE(json.find(R"("port": "lost")"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("stall_detected": 2)"), std::string::npos);
}

}  // namespace
}  // namespace palpate::device
