// The arm's words, by the examples of its service's pages, and whatever else may come.
#include "device/inverse3_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace palpate::device::inverse3 {
namespace {

// As the service's pages show a state: config, state and status of each device.
const std::string reply_text =
    R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3",)"
    R"("device_info":{"major_version":7,"minor_version":4}},)"
    R"("state":{"angular_position":{"a0":1.0,"a1":2,"a2":3},"body_orientation":{"w":1,"x":0,"y":0,)"
    R"("z":0},"control_mode":"cursor_force","current_cursor_force":{"x":0,"y":0,"z":1.5},)"
    R"("cursor_position":{"x":0.05,"y":-0.12,"z":1.5e-1},)"
    R"("cursor_velocity":{"x":0.1,"y":0,"z":-0.2}},"status":{"ready":true}}],"verse_grip":[]})";

Reply reply_with(const std::string& position) {
  return parse_reply(
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)" + position + "}}]}",
      "049D");
}

TEST(Inverse3Reply, HoldsPositionVelocityAndMode) {
  const Reply reply = parse_reply(reply_text, "049D");
  EXPECT_EQ(reply.fault, Fault::none);
  EXPECT_EQ(reply.position, Vec3(0.05, -0.12, 0.15));
  EXPECT_EQ(reply.velocity, Vec3(0.1, 0.0, -0.2));
  EXPECT_EQ(reply.mode, Mode::other);
}

TEST(Inverse3Reply, OfAnOlderServiceCallsItMode) {
  const auto mode = [](const char* word) {
    return parse_reply(
               std::string(R"({"inverse3":[{"device_id":"A","state":{"mode":)") + word + "}}]}",
               "A")
        .mode;
  };
  EXPECT_EQ(mode("\"idle\""), Mode::idle);
  EXPECT_EQ(mode("\"force\""), Mode::other);
  EXPECT_EQ(mode("3"), Mode::unknown);
}

TEST(Inverse3Reply, IsReadInAnyOrder) {
  const Reply reply = parse_reply(
      " { \"x\" : [ { } , [ ] ] , \"inverse3\" : [ {\"state\":{\"control_mode\":\"idle\","
      "\"cursor_position\":{\"z\":3,\"x\":1,\"y\":2,\"w\":null}},\"device_id\":\"A\"} , "
      "{\"device_id\":\"B\",\"state\":{\"cursor_position\":{\"x\":9,\"y\":9,\"z\":9}}} ] } ",
      "A");
  EXPECT_EQ(reply.position, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(reply.mode, Mode::idle);
  EXPECT_FALSE(reply.velocity);
}

TEST(Inverse3Reply, OfAnotherArmIsNone) {
  EXPECT_EQ(parse_reply(reply_text, "04BA").fault, Fault::wrong_device);
  EXPECT_FALSE(parse_reply(reply_text, "04BA").position);
  for (const char* text : {"{}", R"({"inverse3":[]})", R"({"inverse3":{}})", R"({"inverse3":[{}]})",
                           R"({"inverse3":[{"device_id":"049D"}]})", R"({"inverse3":[7]})",
                           R"({"inverse3":[{"device_id":"049D","state":[]}]})"}) {
    EXPECT_EQ(parse_reply(text, "049D").fault, Fault::missing_field) << text;
    EXPECT_FALSE(parse_reply(text, "049D").position) << text;
  }
}

TEST(Inverse3Reply, WantsAWholeFinitePosition) {
  EXPECT_TRUE(reply_with(R"({"x":1,"y":2,"z":3})").position);
  for (const char* position : {R"({"x":1,"y":2})", R"({"x":1,"y":2,"z":"3"})", "[1,2,3]", "null",
                               R"({"x":1,"y":2,"z":null})", R"({"x":1,"y":2,"z":1e400})"}) {
    EXPECT_FALSE(reply_with(position).position) << position;
    EXPECT_EQ(reply_with(position).fault, Fault::missing_field) << position;
  }
  for (const char* position : {R"({"x":1,"y":2,"z":1e308})", R"({"x":1e200,"y":1e200,"z":0})",
                               R"({"x":0,"y":0,"z":-10.1})"}) {
    EXPECT_FALSE(reply_with(position).position) << position;
    EXPECT_EQ(reply_with(position).fault, Fault::not_finite) << position;
  }
}

TEST(Inverse3Reply, WantsAVelocityThatCanBe) {
  const auto reply_at = [](const std::string& speed) {
    return parse_reply(R"({"inverse3":[{"device_id":"049D","state":{)"
                       R"("cursor_position":{"x":0,"y":0,"z":0},)"
                       R"("cursor_velocity":{"x":0,"y":0,"z":)" +
                           speed + "}}}]}",
                       "049D");
  };
  EXPECT_EQ(reply_at("-99").fault, Fault::none);
  EXPECT_EQ(reply_at("-101").fault, Fault::not_finite);
  EXPECT_FALSE(reply_at("1e308").position);
}

TEST(Inverse3Reply, ThatIsNoJsonIsGarbage) {
  for (const char* text : {"",
                           "x",
                           "[]",
                           "{",
                           "{}}",
                           "{\"a\":}",
                           "{\"a\":1,}",
                           "{,}",
                           "{\"a\" 1}",
                           "{a:1}",
                           "{\"a\":NaN}",
                           "{\"a\":Infinity}",
                           "{\"a\":01}",
                           "{\"a\":1.}",
                           "{\"a\":.5}",
                           "{\"a\":+1}",
                           "{\"a\":-}",
                           "{\"a\":1e}",
                           "{\"a\":\"x}",
                           "{\"a\":tru}",
                           "{\"a\":[1,]}",
                           "{\"a\":[1 2]}",
                           "{\"a\":{\"b\":1]}}",
                           "{\"a\":\"\n\"}",
                           "{\"a\":1} x"})
    EXPECT_EQ(parse_reply(text, "049D").fault, Fault::garbage) << text;
  // A prefix of a reply is none.
  for (std::size_t size = 0; size < reply_text.size(); ++size)
    EXPECT_EQ(parse_reply(std::string_view(reply_text).substr(0, size), "049D").fault,
              Fault::garbage)
        << size;
  const std::string deep = "{\"a\":" + std::string(100000, '[');
  EXPECT_EQ(parse_reply(deep, "049D").fault, Fault::garbage);
}

// The scanner against the library's parser: what one takes for JSON the other does, too.
TEST(Inverse3Reply, IsJsonWhereTheLibrarySaysSo) {
  std::mt19937 random(11);
  const std::string alphabet = "{}[]\",:0123456789.eE+-truefalsn xyz\\";
  int valid = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = reply_text;
    for (unsigned edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      const char other = alphabet[random() % alphabet.size()];
      if (random() % 3 == 0) {
        text.erase(at, 1);
      } else if (random() % 2 == 0) {
        text.insert(at, 1, other);
      } else {
        text[at] = other;
      }
    }
    // Texts are not unescaped by the scanner, nor are their escapes checked; and a number that no
    // double holds is passed over there, an error here.
    if (text.find('\\') != std::string::npos) continue;
    const auto parsed = nlohmann::json::parse(text, nullptr, false);
    const bool ours = parse_reply(text, "049D").fault != Fault::garbage;
    if (parsed.is_object()) {
      ++valid;
      EXPECT_TRUE(ours) << text;
    } else if (ours) {
      EXPECT_NE(text.find_first_of("eE"), std::string::npos) << text;
    }
  }
  EXPECT_GT(valid, 1000);
}

TEST(Inverse3Reply, TellsThatTheArmsOwnSafetyHasActed) {
  const auto fault = [](const char* status) {
    return parse_reply(std::string(R"({"inverse3":[{"device_id":"A","status":)") + status +
                           R"(,"state":{"cursor_position":{"x":0,"y":0,"z":0}}}]})",
                       "A")
        .fault;
  };
  EXPECT_EQ(fault(R"({"ready":true,"calibrated":true})"), Fault::none);
  EXPECT_EQ(fault(R"({"ready":false})"), Fault::brake);
  EXPECT_EQ(fault(R"({"calibrated":false})"), Fault::brake);
  EXPECT_EQ(fault(R"({"ebrake":true})"), Fault::brake);
  EXPECT_EQ(fault(R"({"ebrake":"soon"})"), Fault::none);
}

TEST(Inverse3Version, ChoosesTheSpelling) {
  EXPECT_EQ(parse_version(R"({"git_tag":"3.5.0","project_version":"3.5.0.0"})"), "3.5.0.0");
  EXPECT_EQ(parse_version(R"({"ok":true,"data":{"git_tag":"3.1.1"}})"), "3.1.1");
  for (const char* text : {"", "x", "[]", "{}", R"({"project_version":[]})", R"({"data":7})"})
    EXPECT_EQ(parse_version(text), "") << text;
  EXPECT_EQ(spelling_of("3.5.0.0"), Spelling::vector);
  EXPECT_EQ(spelling_of("3.10"), Spelling::vector);
  EXPECT_EQ(spelling_of("4.0"), Spelling::vector);
  EXPECT_EQ(spelling_of("3.1.1"), Spelling::values);
  EXPECT_EQ(spelling_of("2.9"), Spelling::values);
  EXPECT_EQ(spelling_of(""), Spelling::vector);
  EXPECT_EQ(spelling_of("next"), Spelling::vector);
}

TEST(Inverse3Snapshot, ListsTheArmsThatCanBeSpokenTo) {
  const auto snapshot = parse_snapshot(reply_text);
  ASSERT_TRUE(snapshot);
  ASSERT_EQ(snapshot->arms.size(), 1u);
  EXPECT_EQ(snapshot->arms[0].id, "049D");
  EXPECT_EQ(snapshot->arms[0].model, "inverse3");
  EXPECT_EQ(snapshot->arms[0].firmware, "7.4");
  EXPECT_FALSE(parse_snapshot("[]"));
  EXPECT_FALSE(parse_snapshot("{"));
  EXPECT_TRUE(parse_snapshot("{}")->arms.empty());
  EXPECT_TRUE(
      parse_snapshot(R"({"inverse3":[{"device_id":"a\"b"},{"device_id":""},{},7]})")->arms.empty());
}

TEST(Inverse3Force, IsSpelledAsTheServiceWantsIt) {
  EXPECT_EQ(force_message("049D", Spelling::vector, {0.0, 0.0, 1.5}).text(),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":)"
            R"({"vector":{"x":0,"y":0,"z":1.5}}}}]})");
  EXPECT_EQ(force_message("049D", Spelling::values, {0.0, -1e-7, 0.0}).text(),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":)"
            R"({"values":{"x":0,"y":-1e-07,"z":0}}}}]})");
}

TEST(Inverse3Force, IsAlwaysJsonAndNeverNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double largest = -std::numeric_limits<double>::max();
  const std::string id(31, 'A');
  for (const Vec3& force : {Vec3(nan, 1, 1), Vec3(1, INFINITY, 1), Vec3(largest, largest, largest),
                            Vec3(-2.2250738585072014e-308, 0.1, 1.0 / 3.0)}) {
    const auto message = force_message(id, Spelling::vector, force);
    const auto json = nlohmann::json::parse(message.text(), nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << message.text();
    const auto& sent = json["inverse3"][0]["commands"]["set_cursor_force"]["vector"];
    EXPECT_EQ(sent["y"], force.allFinite() ? force.y() : 0.0);
  }
}

}  // namespace
}  // namespace palpate::device::inverse3
