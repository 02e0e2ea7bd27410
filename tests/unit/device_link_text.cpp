// LINK texts: the three forms, and a sentence with all of them for everything else.
#include "device/link.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "base/error.h"
#include "refusal.h"

namespace palpate::device {
namespace {

TEST(LinkText, ReadsTheFourForms) {
  EXPECT_EQ(std::get<StandAddress>(parse_link("mark10:/dev/ttyUSB0")).port, "/dev/ttyUSB0");
  EXPECT_EQ(std::get<StandAddress>(parse_link("mark10:/dev/serial/by-id/a:b")).port,
            "/dev/serial/by-id/a:b");
  const auto arm = std::get<ArmAddress>(parse_link("inverse3:localhost:10001"));
  EXPECT_EQ(arm.host, "localhost");
  EXPECT_EQ(arm.port, 10001);
  EXPECT_EQ(std::get<ArmAddress>(parse_link("inverse3:[::1]:1")).host, "::1");
  const auto gauge = std::get<GaugeAddress>(parse_link("serial:/dev/tty:A,B,set tings.toml"));
  EXPECT_EQ(gauge.port, "/dev/tty:A,B");
  EXPECT_EQ(gauge.settings, "set tings.toml");
  EXPECT_EQ(std::get<RecordingAddress>(parse_link("replay:a run.csv")).file, "a run.csv");
}

TEST(LinkText, ReadsAPortOfEvents) {
  const auto events = [](std::string_view text) {
    return std::get<ArmAddress>(parse_link(text)).events;
  };
  EXPECT_EQ(events("inverse3:localhost:10001"), 10020);
  EXPECT_EQ(events("inverse3:localhost:10001:4711"), 4711);
  EXPECT_EQ(events("inverse3:localhost:10001:none"), std::nullopt);
  const auto arm = std::get<ArmAddress>(parse_link("inverse3:[fe80::1]:10001:10021"));
  EXPECT_EQ(arm.host, "fe80::1");
  EXPECT_EQ(arm.port, 10001);
  EXPECT_EQ(arm.events, 10021);
}

TEST(LinkText, ReadsTheIdOfAnArm) {
  const auto arm = std::get<ArmAddress>(parse_link("inverse3:localhost:10001/0BAD"));
  EXPECT_EQ(arm.id, "0BAD");
  EXPECT_EQ(arm.port, 10001);
  EXPECT_EQ(std::get<ArmAddress>(parse_link("inverse3:[::1]:1:none/12")).id, "12");
  EXPECT_EQ(std::get<ArmAddress>(parse_link("inverse3:localhost:1")).id, "");
}

TEST(LinkText, TellsWhatOnlyReads) {
  EXPECT_TRUE(only_reads(parse_link("serial:x,y")));
  EXPECT_TRUE(only_reads(parse_link("replay:x")));
  EXPECT_FALSE(only_reads(parse_link("mark10:x")));
  EXPECT_FALSE(only_reads(parse_link("inverse3:x:1")));
}

std::string link_refusal(std::string_view text) {
  return test::refusal([&] { return parse_link(text); });
}

TEST(LinkText, RefusesEverythingElseAndShowsTheForms) {
  for (const char* text : {"",
                           "mark10",
                           "mark10:",
                           "inverse3",
                           "inverse3:",
                           "inverse3:localhost",
                           "inverse3:localhost:",
                           "inverse3::1",
                           "inverse3:localhost:0",
                           "inverse3:localhost:65536",
                           "inverse3:localhost:1:",
                           "inverse3:localhost:1:0",
                           "inverse3:localhost:1:x",
                           "inverse3:localhost:1:2:3",
                           "inverse3:localhost:1:none:",
                           "inverse3:[::1]",
                           "inverse3:[::1:1",
                           "inverse3:[]:1",
                           "inverse3:[::1]1",
                           "inverse3:::1:1",
                           "inverse3:localhost:1x",
                           "inverse3:localhost:-1",
                           "inverse3:localhost:1/",
                           "inverse3:localhost/049D",
                           "serial:",
                           "serial:/dev/ttyACM0",
                           "serial:/dev/ttyACM0,",
                           "serial:,gauge.toml",
                           "replay:",
                           "mark11:/dev/ttyUSB0",
                           ":"}) {
    const std::string message = link_refusal(text);
    EXPECT_NE(message.find("`mark10:/dev/ttyUSB0`"), std::string::npos) << text;
    EXPECT_NE(message.find("`" + std::string(text) + "`"), std::string::npos) << text;
  }
  EXPECT_NE(link_refusal("inverse3:localhost:1:x").find("or `none`"), std::string::npos);
  EXPECT_NE(link_refusal("mark11:x").find("did you mean `mark10:`"), std::string::npos);
}

}  // namespace
}  // namespace palpate::device
