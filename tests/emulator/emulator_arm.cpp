// The arm's messages on the virtual clock, without a socket.
#include "emulator/arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace emulator {
namespace {

using nlohmann::json;

ArmSettings lockstep(Service service = Service::v3_5) {
  ArmSettings settings;
  settings.clock = Clock::lockstep;
  settings.service = service;
  return settings;
}

class Client {
 public:
  explicit Client(const ArmSettings& settings) : arm(settings, log_) {}
  json greet() { return json::parse(arm.greet().text); }
  json say(const std::string& text) {
    const Answer answer = arm.answer(text);
    EXPECT_EQ(answer.messages.size(), 1U) << "exactly one reply a message";
    return json::parse(answer.messages.at(0).text)["inverse3"][0];
  }
  json force(double z, const std::string& spelling = "vector") {
    const json vector{{"x", 0.0}, {"y", 0.0}, {"z", z}};
    return say(json{
        {"inverse3",
         {{{"device_id", "049D"}, {"commands", {{"set_cursor_force", {{spelling, vector}}}}}}}}}
                   .dump());
  }

 private:
  Log log_{"", ""};

 public:
  Arm arm;
};

// docs.haply.co/inverseSDK/service/realtime/websocket-protocol, 3.5.x, step 1.
TEST(EmulatorArm, GreetsWithAFullSnapshot) {
  Client client(lockstep());
  const json snapshot = client.greet();
  EXPECT_TRUE(snapshot["session_id"].is_number_integer());
  ASSERT_EQ(snapshot["inverse3"].size(), 1U);
  const json& device = snapshot["inverse3"][0];
  EXPECT_EQ(device["device_id"], "049D");
  for (const char* key :
       {"type", "port", "device_info", "extended_device_id", "extended_firmware_version",
        "gravity_compensation", "handedness", "streaming_mode", "torque_scaling", "home_return",
        "preset", "basis", "mount", "filters"})
    EXPECT_TRUE(device["config"].contains(key)) << key;
  for (const char* key :
       {"cursor_position", "cursor_velocity", "angular_position", "angular_velocity",
        "body_orientation", "current_cursor_force", "current_cursor_position",
        "current_angular_torques", "current_angular_position", "control_domain", "control_mode",
        "transform"})
    EXPECT_TRUE(device["state"].contains(key)) << key;
  EXPECT_EQ(device["state"]["control_mode"], "idle");
  EXPECT_EQ(device["state"]["cursor_position"], json({{"x", 0.0}, {"y", -0.12}, {"z", 0.15}}));
  for (const char* key : {"calibrated", "in_use", "power_supply", "ready", "started"})
    EXPECT_TRUE(device["status"][key].is_boolean()) << key;
  EXPECT_TRUE(snapshot["verse_grip"].is_array());
}

TEST(EmulatorArm, UpdatesWithStateAndStatusOnly) {
  Client client(lockstep());
  const json device = client.force(0.5);
  EXPECT_EQ(device["device_id"], "049D");
  EXPECT_FALSE(device.contains("config"));
  EXPECT_EQ(device["state"]["control_mode"], "force");
  EXPECT_EQ(device["state"]["current_cursor_force"]["z"], 0.5);
  EXPECT_TRUE(device.contains("status"));
  const json full = client.say(R"({"session":{"force_render_full_state":{}}})");
  EXPECT_TRUE(full.contains("config"));
  EXPECT_EQ(full["state"]["control_mode"], "idle") << "a tick without a command lets go";
}

TEST(EmulatorArm, SpellsTheForceAsItsVersionDoes) {
  Client newer(lockstep());
  EXPECT_EQ(newer.force(1.0, "values")["state"]["control_mode"], "force");  // the older word too
  EXPECT_EQ(newer.force(1.0, "forces")["state"]["control_mode"], "idle");
  EXPECT_EQ(newer.force(1.0, "vector")["state"]["control_mode"], "force");
  Client older(lockstep(Service::v3_1));
  EXPECT_EQ(older.force(1.0, "vector")["state"]["mode"], "idle");
  EXPECT_EQ(older.force(1.0, "values")["state"]["mode"], "force");
  EXPECT_EQ(older.arm.force()[2], 1.0);
  EXPECT_FALSE(older.greet().contains("session_id"));
}

TEST(EmulatorArm, ClampsTheVectorsLength) {
  ArmSettings settings = lockstep();
  settings.force_limit = 5.0;
  Client client(settings);
  client.say(R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":
      {"vector":{"x":30.0,"y":0.0,"z":-40.0}}}}]})");
  EXPECT_NEAR(client.arm.force()[0], 3.0, 1e-15);  // rounding
  EXPECT_NEAR(client.arm.force()[2], -4.0, 1e-15);
  client.force(1e308);
  EXPECT_TRUE(std::isfinite(client.arm.force()[2]));
  EXPECT_LE(client.arm.force()[2], 5.0);
  EXPECT_NE(client.arm.summary().find("\"clamped\":2"), std::string::npos);
}

TEST(EmulatorArm, AnswersOnceWhateverItHears) {
  Client client(lockstep());
  for (const char* text :
       {"", "[]", "no json", "{\"inverse3\":", "{\"inverse3\":7}", "{\"inverse3\":[3]}",
        "{\"inverse3\":[{\"device_id\":\"049D\",\"commands\":5}]}",
        "{\"inverse3\":[{\"device_id\":\"049D\",\"commands\":{\"set_cursor_force\":"
        "{\"vector\":{\"x\":\"1\",\"y\":0,\"z\":0}}}}]}",
        "{\"inverse3\":[{\"device_id\":\"AAAA\",\"commands\":{\"set_cursor_force\":"
        "{\"vector\":{\"x\":1,\"y\":0,\"z\":0}}}}]}",
        "{\"session\":{\"configure\":{\"profile\":{\"name\":\"a\"}}}}", "\xff\xfe"}) {
    EXPECT_EQ(client.say(text)["state"]["control_mode"], "idle") << text;
    EXPECT_EQ(client.arm.force(), Vec3{}) << text;
  }
  EXPECT_EQ(client.arm.messages(), 11);
}

TEST(EmulatorArm, AddsTheForcesOfOneTick) {
  Client client(lockstep());
  client.say(R"({"inverse3":[
    {"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":1,"y":0,"z":0}}}},
    {"device_id":"049D","commands":{"set_cursor_force":{"vector":{"x":0.5,"y":0,"z":2}}}}]})");
  EXPECT_EQ(client.arm.force(), (Vec3{1.5, 0.0, 2.0}));
}

TEST(EmulatorArm, EachMessageIsAPeriod) {
  Client client(lockstep());
  for (int i = 1; i <= 300; ++i) {
    client.force(1.5);
    EXPECT_EQ(client.arm.now(), i * 1'000'000);
  }
  // The hand's own oscillator under a constant force for 300 ms: overdamped or not, it is the same
  // as 2400 steps of the hand alone.
  Hand hand = make_hand(lockstep().hand, 1.0 / 8000.0);
  for (int i = 0; i < 2400; ++i) move(hand, {0.0, 0.0, 1.5}, {});
  EXPECT_EQ(client.arm.hand().position, hand.position);
  EXPECT_EQ(client.force(1.5)["state"]["cursor_position"]["z"], client.arm.hand().position[2])
      << "a number comes back as it was written";
}

TEST(EmulatorArm, SettlesWhereSpringAndForceBalance) {
  Client client(lockstep());
  for (int i = 0; i < 1500; ++i) client.force(1.5);
  const json state = client.force(1.5)["state"];
  // k = 300 N/m: 5 mm; exp(-b t / 2 m) = exp(-30) is left of the way there.
  EXPECT_NEAR(state["cursor_position"]["z"].get<double>(), 0.15 + 1.5 / 300.0, 1e-12);
  EXPECT_NEAR(state["cursor_velocity"]["z"].get<double>(), 0.0, 1e-12);
}

TEST(EmulatorArm, IsIdleAfterSilenceAndWhenLeft) {
  ArmSettings settings = lockstep();
  settings.clock = Clock::real;
  settings.idle_after = 50e-3;  // s
  Client client(settings);
  client.greet();
  EXPECT_EQ(client.arm.pass(10'000'000), Act::none);
  client.force(2.0);
  (void)client.arm.pass(59'000'000);
  EXPECT_EQ(client.arm.force()[2], 2.0);
  (void)client.arm.pass(200'000'000);
  EXPECT_EQ(client.arm.force(), Vec3{});
  // It let go at 60 ms, whenever that was looked at: 400 steps with the force, not 1520.
  Hand hand = make_hand(settings.hand, 1.0 / 8000.0);
  for (int i = 0; i < 1600; ++i) move(hand, {0.0, 0.0, i >= 80 && i < 480 ? 2.0 : 0.0}, {});
  EXPECT_EQ(client.arm.hand().position, hand.position);
  client.force(2.0);
  client.arm.leave();
  EXPECT_EQ(client.arm.force(), Vec3{});
}

TEST(EmulatorArm, MeetsItsOwnTissueIfThereIsOne) {
  ArmSettings settings = lockstep();
  settings.tissue =
      TissueSettings{.E0 = 50e3, .E_inf = 50e3, .tau = 1.0, .R = 8e-3, .surface = 0.145};
  settings.hand.waypoints = {{0.3, {0.0, -0.12, 0.14}}};
  Client client(settings);
  for (int i = 0; i < 1500; ++i) client.force(0.0);
  const double z = client.arm.hand().position[2];
  // k (z_intent - z) + F(surface - z) = 0 at rest
  const double pushed = 4.0 / 3.0 * 50e3 / 0.75 * std::sqrt(8e-3) * std::pow(0.145 - z, 1.5);
  EXPECT_NEAR(pushed, 300.0 * (z - 0.14), 1e-9);
  EXPECT_EQ(client.arm.hand().work, 0.0) << "the tissue's work is not the device's";
}

TEST(EmulatorArm, RepeatsItself) {
  const auto all = [] {
    Client client(lockstep());
    std::string text = client.arm.greet().text;
    for (int i = 0; i < 200; ++i) text += client.arm.answer("{}").messages.at(0).text;
    return text;
  };
  EXPECT_EQ(all(), all());
}

TEST(EmulatorArm, TellsItsVersion) {
  EXPECT_EQ(json::parse(version_body(Service::v3_5))["project_version"], "3.5.0.0");
  EXPECT_EQ(json::parse(version_body(Service::v3_1))["git_tag"], "3.1.0");
}

}  // namespace
}  // namespace emulator
