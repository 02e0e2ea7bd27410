// Every fault of the arm does what its line in the list says.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "emulator/arm.h"

namespace emulator {
namespace {

using nlohmann::json;

Fault arm_fault(const std::string& kind, std::int64_t after,
                std::optional<Nanoseconds> duration = {}, double value = 0.0) {
  for (const FaultKind& known : arm_faults())
    if (known.name == kind)
      return {.kind = kind,
              .life = known.life,
              .after_messages = after,
              .duration = duration,
              .value = value};
  ADD_FAILURE() << "no fault " << kind;
  return {};
}

const std::string push = R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":
    {"vector":{"x":0,"y":0,"z":2.0}}}}]})";

class FaultyArm {
 public:
  explicit FaultyArm(const Fault& fault) : arm(settings(fault), log_) {}
  Answer say() { return arm.answer(push); }
  std::string text() { return one(say()); }
  json device() { return json::parse(text())["inverse3"][0]; }
  static std::string one(const Answer& answer) {
    EXPECT_EQ(answer.messages.size(), 1U);
    return answer.messages.empty() ? "" : answer.messages[0].text;
  }

 private:
  static ArmSettings settings(const Fault& fault) {
    ArmSettings settings;
    settings.clock = Clock::lockstep;
    settings.faults = {fault};
    return settings;
  }
  Log log_{"", ""};

 public:
  Arm arm;
};

bool is_sound(const std::string& text) {
  const json message = json::parse(text, nullptr, false);
  return message.is_object() && message["inverse3"].size() == 1 &&
         message["inverse3"][0]["device_id"] == "049D" &&
         message["inverse3"][0]["state"]["cursor_position"]["z"].is_number() &&
         message["inverse3"][0]["state"]["cursor_position"]["z"] < 1.0;
}

// Those that spoil the text of one reply: the one before and the one after are sound.
TEST(EmulatorArmFaults, SpoilOneReply) {
  const std::pair<const char*, bool (*)(const std::string&)> rows[] = {
      {"invalid_json", [](const std::string& text) { return !json::accept(text); }},
      {"partial",
       [](const std::string& text) { return !json::accept(text) && text.starts_with("{\"inv"); }},
      {"missing_field",
       [](const std::string& text) {
         const json state = json::parse(text)["inverse3"][0]["state"];
         return !state.contains("cursor_position") && state.contains("cursor_velocity");
       }},
      {"wrong_type",
       [](const std::string& text) {
         return json::parse(text)["inverse3"][0]["state"]["cursor_position"]["x"].is_string();
       }},
      {"empty", [](const std::string& text) { return text == "{}"; }},
      {"no_device",
       [](const std::string& text) { return json::parse(text)["inverse3"] == json::array(); }},
      {"nan",
       [](const std::string& text) {
         return !json::accept(text) && text.find("\"z\":NaN") != std::string::npos;
       }},
      {"huge",
       [](const std::string& text) {
         return json::parse(text)["inverse3"][0]["state"]["cursor_position"]["z"] == 1e308;
       }},
      {"velocity_spike",
       [](const std::string& text) {
         return json::parse(text)["inverse3"][0]["state"]["cursor_velocity"]["z"] == -1000.0;
       }},
  };
  for (const auto& [kind, spoilt] : rows) {
    FaultyArm client(arm_fault(kind, 1));
    EXPECT_TRUE(is_sound(client.text())) << kind;
    EXPECT_TRUE(spoilt(client.text())) << kind;
    const std::string after = client.text();
    EXPECT_TRUE(is_sound(after)) << kind;
    EXPECT_FALSE(spoilt(after)) << kind;
  }
}

TEST(EmulatorArmFaults, OfEventsSayWhatTheirNamesSay) {
  const auto said = [](const char* kind) {
    FaultyArm client(arm_fault(kind, 1, 2'000'000));
    EXPECT_TRUE(is_sound(client.text())) << kind;
    EXPECT_TRUE(client.arm.take_events().empty()) << kind << ": before its time";
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(is_sound(client.text())) << kind << ": the arm goes on";
    return client.arm.take_events();
  };
  const auto only = [&](const char* kind) {
    const auto events = said(kind);
    EXPECT_EQ(events.size(), 1U) << kind;
    return events.empty() ? json() : json::parse(events[0], nullptr, false);
  };
  for (const auto& [kind, type] :
       {std::pair{"event_stall", "stall_detected"}, std::pair{"event_ceiling", "stability_ceiling"},
        std::pair{"event_stage", "fod_stage_changed"},
        std::pair{"event_unknown", "something_new"}}) {
    const json event = only(kind);
    EXPECT_EQ(event["name"], "device-safety-triggered") << kind;
    EXPECT_EQ(event["data"]["safety_type"], type);
    EXPECT_EQ(event["data"]["device_id"], "049D") << kind;
  }
  EXPECT_EQ(only("event_other")["data"]["device_id"], "0BAD");
  EXPECT_EQ(only("event_busy")["name"], "device-busy");
  EXPECT_EQ(only("event_disconnect")["name"], "device-disconnected");
  EXPECT_TRUE(only("event_garbage").is_discarded());
  EXPECT_TRUE(only("event_partial").is_discarded());
  EXPECT_GT(only("event_huge").dump().size(), 200'000U);
  EXPECT_EQ(said("event_flood").size(), 2000U);
  const auto brake = said("event_brake");
  ASSERT_EQ(brake.size(), 2U);
  EXPECT_EQ(json::parse(brake[0])["data"]["safety_type"], "ebrake_triggered");
  EXPECT_EQ(json::parse(brake[1])["data"]["safety_type"], "ebrake_released");
  FaultyArm close(arm_fault("events_close", 0));
  close.say();
  EXPECT_TRUE(close.arm.take_events_end());
  EXPECT_FALSE(close.arm.take_events_end()) << "once";
}

TEST(EmulatorArmFaults, MayComeTogether) {
  ArmSettings settings;
  settings.clock = Clock::lockstep;
  for (const FaultKind& kind : arm_faults())
    if (kind.life == Life::replies) settings.faults.push_back(arm_fault(std::string(kind.name), 0));
  Log log("", "");
  Arm arm(settings, log);
  for (int i = 0; i < 10; ++i) EXPECT_LE(arm.answer(push).messages.size(), 3U);
  EXPECT_TRUE(is_sound(FaultyArm::one(arm.answer(push))));
}

TEST(EmulatorArmFaults, BinaryIsTheSameInAnotherKindOfMessage) {
  FaultyArm client(arm_fault("binary", 1));
  EXPECT_FALSE(client.say().messages.at(0).binary);
  const Answer odd = client.say();
  EXPECT_TRUE(odd.messages.at(0).binary);
  EXPECT_TRUE(is_sound(odd.messages.at(0).text));
  EXPECT_FALSE(client.say().messages.at(0).binary);
}

TEST(EmulatorArmFaults, RepliesAreLostDoubledAndReordered) {
  FaultyArm drop(arm_fault("drop", 1));
  EXPECT_EQ(drop.say().messages.size(), 1U);
  EXPECT_EQ(drop.say().messages.size(), 0U);
  EXPECT_EQ(drop.say().messages.size(), 1U);
  FaultyArm duplicate(arm_fault("duplicate", 1));
  duplicate.say();
  const Answer twice = duplicate.say();
  ASSERT_EQ(twice.messages.size(), 2U);
  EXPECT_EQ(twice.messages[0].text, twice.messages[1].text);
  FaultyArm reorder(arm_fault("reorder", 1));
  FaultyArm plain(arm_fault("reorder", 100));
  reorder.say();
  plain.say();
  const std::string second = plain.text();
  const std::string third = plain.text();
  EXPECT_EQ(reorder.say().messages.size(), 0U);
  const Answer both = reorder.say();
  ASSERT_EQ(both.messages.size(), 2U);
  EXPECT_EQ(both.messages[0].text, third);
  EXPECT_EQ(both.messages[1].text, second);
  EXPECT_EQ(reorder.say().messages.size(), 1U);
}

TEST(EmulatorArmFaults, LateTakesItsTime) {
  FaultyArm client(arm_fault("late", 1, {}, 0.03));
  client.say();
  const Answer late = client.say();
  EXPECT_EQ(late.messages.at(0).delay, 30'000'000);
  EXPECT_EQ(client.arm.now(), 2'000'000 + 30'000'000) << "the hand moves on meanwhile";
  EXPECT_EQ(client.say().messages.at(0).delay, 0);
}

TEST(EmulatorArmFaults, ConnectionsEnd) {
  const std::pair<const char*, Act> rows[] = {{"rst", Act::reset_connection},
                                              {"close_1000", Act::close_normal},
                                              {"close_1011", Act::close_error},
                                              {"reset", Act::restart}};
  for (const auto& [kind, act] : rows) {
    FaultyArm client(arm_fault(kind, 1));
    EXPECT_EQ(client.say().act, Act::none) << kind;
    const Answer end = client.say();
    EXPECT_EQ(end.act, act) << kind;
    EXPECT_TRUE(end.messages.empty()) << kind;
    EXPECT_EQ(client.say().act, Act::none) << kind;
  }
  FaultyArm client(arm_fault("reset", 0));
  const int before = json::parse(client.arm.greet().text)["session_id"];
  client.say();
  EXPECT_NE(json::parse(client.arm.greet().text)["session_id"], before);
}

TEST(EmulatorArmFaults, HalfOpenIsSilent) {
  FaultyArm client(arm_fault("half_open", 1));
  client.say();
  EXPECT_FALSE(client.arm.silent());
  EXPECT_TRUE(client.say().messages.empty());
  EXPECT_TRUE(client.arm.silent());
}

TEST(EmulatorArmFaults, DevicesChange) {
  FaultyArm id(arm_fault("id_change", 1, 2'000'000));
  EXPECT_EQ(id.device()["device_id"], "049D");
  EXPECT_EQ(id.device()["device_id"], "0BAD");
  id.say();
  EXPECT_EQ(id.device()["device_id"], "049D");
  FaultyArm second(arm_fault("second_device", 1));
  EXPECT_EQ(json::parse(second.text())["inverse3"].size(), 1U);
  const json two = json::parse(second.text())["inverse3"];
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0]["device_id"], "0BAD");
  EXPECT_EQ(two[1]["device_id"], "049D");
}

TEST(EmulatorArmFaults, ThePositionLies) {
  FaultyArm jump(arm_fault("jump", 1, {}, 0.05));
  const double before = jump.device()["state"]["cursor_position"]["z"];
  const double told = jump.device()["state"]["cursor_position"]["z"];
  EXPECT_NEAR(told - before, 0.05, 1e-4);  // and a millisecond's way
  EXPECT_NEAR(told - 0.05, jump.arm.hand().position[2], 1e-15) << "the hand itself does not jump";
  FaultyArm freeze(arm_fault("freeze", 1, 5'000'000));
  const json first = freeze.device()["state"];
  EXPECT_EQ(freeze.device()["state"], first);
  EXPECT_EQ(freeze.device()["state"], first);
  for (int i = 0; i < 4; ++i) freeze.say();
  EXPECT_NE(freeze.device()["state"], first);
}

TEST(EmulatorArmFaults, TheBrakeHoldsAndIsReported) {
  FaultyArm client(arm_fault("brake", 3, 5'000'000));
  for (int i = 0; i < 3; ++i) client.say();
  EXPECT_TRUE(client.arm.take_events().empty());
  const double z = client.arm.hand().position[2];
  const json braked = client.device();
  EXPECT_EQ(braked["state"]["control_mode"], "idle");
  EXPECT_EQ(client.arm.force(), Vec3{});
  EXPECT_EQ(client.arm.hand().position[2], z);
  const auto events = client.arm.take_events();
  ASSERT_EQ(events.size(), 1U);
  const json event = json::parse(events[0]);
  EXPECT_EQ(event["name"], "device-safety-triggered");
  EXPECT_EQ(event["level"], "error");
  EXPECT_EQ(event["data"]["safety_type"], "ebrake_triggered");
  EXPECT_EQ(event["data"]["device_id"], "049D");
  for (int i = 0; i < 8; ++i) client.say();
  EXPECT_EQ(json::parse(client.arm.take_events().at(0))["data"]["safety_type"], "ebrake_released");
  EXPECT_EQ(client.arm.force()[2], 2.0);
}

TEST(EmulatorArmFaults, NotReadyTakesNoForce) {
  FaultyArm client(arm_fault("not_ready", 1, 3'000'000));
  EXPECT_EQ(client.device()["status"]["ready"], true);
  const json device = client.device();
  EXPECT_EQ(device["status"]["ready"], false);
  EXPECT_EQ(device["status"]["calibrated"], false);
  EXPECT_EQ(client.arm.force(), Vec3{});
  for (int i = 0; i < 4; ++i) client.say();
  EXPECT_EQ(client.arm.force()[2], 2.0);
}

TEST(EmulatorArmFaults, BeginAtTheirTime) {
  Fault timed = arm_fault("empty", 0);
  timed.after_messages.reset();
  timed.at = 4'500'000;
  FaultyArm client(timed);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(is_sound(client.text()));
  EXPECT_EQ(client.text(), "{}");
  EXPECT_TRUE(is_sound(client.text()));
}

}  // namespace
}  // namespace emulator
