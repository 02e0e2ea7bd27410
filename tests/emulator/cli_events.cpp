// What the programs say of an arm's events: a probe's notes, a run's health.
#include <gtest/gtest.h>

#include "live_session.h"

namespace palpate {
namespace {

using test::has;
using test::Played;
using test::Session;

TEST(ArmEvents, AProbeSaysThatTheyAreNotHeard) {
  const test::TemporaryFolder folder;
  std::string nobodys_port;
  {
    const test::LiveEmulator gone({"inverse3"});
    nobodys_port = gone.port();
  }
  const test::LiveEmulator arm({"inverse3", "--clock", "virtual"});
  const std::string link = "inverse3:127.0.0.1:" + arm.port();
  const auto unheard = test::palpate(folder.path(), {"device", "probe", link + ":" + nobodys_port});
  EXPECT_EQ(unheard.code, 0) << unheard.err;
  EXPECT_TRUE(has(unheard.out, "events are not heard")) << unheard.out;
  EXPECT_TRUE(has(unheard.out, "127.0.0.1:" + nobodys_port)) << unheard.out;
  const auto json = test::palpate(folder.path(), {"device", "probe", arm.arm_link(), "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.out).at("events").at("port"), "heard") << json.out;
  EXPECT_FALSE(has(json.out, "not heard")) << json.out;
}

TEST(ArmEvents, AProbeFailsForAnArmThatWasDisconnected) {
  const test::TemporaryFolder folder;
  const test::ScratchFile file("[[fault]]\nkind = \"event_disconnect\"\nat = \"50 ms\"\n");
  const test::LiveEmulator arm({"inverse3", "--clock", "virtual", "--fault", file.path()});
  const auto ended = test::palpate(folder.path(), {"device", "probe", arm.arm_link()});
  EXPECT_EQ(ended.code, 6);
  EXPECT_TRUE(has(ended.err, "hung up")) << ended.err;
}

TEST(ArmEvents, ARunKeepsThemInItsHealthAndItsTraffic) {
  const test::ScratchFile file("[[fault]]\nkind = \"event_stall\"\nat = \"1.3 s\"\n");
  const Played played(Session{.link = "inverse3",
                              .scenario = "device_arm",
                              .emulator = {"--fault", file.path()},
                              .options = {"--arm", "--traffic"}});
  EXPECT_EQ(played.ended.code, 6);
  EXPECT_TRUE(has(played.ended.err, "own safety has acted")) << played.ended.err;
  EXPECT_EQ(played.health.at("events").at("port"), "heard");
  EXPECT_EQ(played.health.at("events").at("counts").at("stall_detected"), 1);
  const auto& states = played.health.at("states");
  const auto tripped = std::find_if(states.begin(), states.end(),
                                    [](const auto& one) { return one.at("state") == "tripped"; });
  ASSERT_NE(tripped, states.end());
  EXPECT_EQ(tripped->at("fault"), "the device says that a motor stalls");
  EXPECT_TRUE(has(test::read_file(played.result("device_arm") / "traffic.csv"), "stall_detected"));
}

}  // namespace
}  // namespace palpate
