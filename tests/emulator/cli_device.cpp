// `palpate device` as a program against the emulator as another.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "live_emulator.h"
#include "program.h"

namespace palpate::test {
namespace {

std::vector<nlohmann::json> objects_in(const std::string& text) {
  std::vector<nlohmann::json> objects;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) objects.push_back(nlohmann::json::parse(line));
  return objects;
}

TEST(DeviceProbe, SaysWhoIsThereOnBothLinks) {
  const TemporaryFolder folder;
  const LiveEmulator stand({"mark10", "--clock", "virtual", "--tissue", "none"});
  const Ended probed = palpate(folder.path(), {"device", "probe", "mark10:" + stand.port()});
  EXPECT_EQ(probed.code, 0) << probed.err;
  for (const char* part : {"stand with force gauge", "EMULATOR", "M5-2", "V1.00", "gauge in N",
                           "travel", "samples/s", "force"})
    EXPECT_TRUE(has(probed.out, part)) << part << "\n" << probed.out;
  const LiveEmulator arm({"inverse3", "--clock", "virtual"});
  const Ended asked = palpate(folder.path(), {"device", "probe", arm.arm_link()});
  EXPECT_EQ(asked.code, 0) << asked.err;
  for (const char* part : {"haptic arm", "3.5.0.0", "vector", "samples/s"})
    EXPECT_TRUE(has(asked.out, part)) << part << "\n" << asked.out;
}

TEST(DeviceProbe, MovesNothingAndSendsNoForce) {
  const TemporaryFolder folder;
  const ScratchFile stand_log("");
  const ScratchFile arm_log("");
  {
    LiveEmulator stand({"mark10", "--clock", "virtual", "--log", stand_log.path()});
    EXPECT_EQ(palpate(folder.path(), {"device", "probe", "mark10:" + stand.port()}).code, 0);
    const auto summary = stand.end();
    EXPECT_EQ(summary.at("summary").at("moving"), false);
    EXPECT_EQ(summary.at("summary").at("position_m"), 0.0);
    LiveEmulator arm({"inverse3", "--clock", "virtual", "--log", arm_log.path()});
    EXPECT_EQ(palpate(folder.path(), {"device", "probe", arm.arm_link()}).code, 0);
    arm.end();
  }
  std::istringstream lines(arm_log.text());
  int probes = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_FALSE(has(line, "set_cursor_force")) << line;
    if (has(line, R"({""probe_position"":{}})")) ++probes;
  }
  EXPECT_GT(probes, 10);
}

TEST(DeviceMonitor, GivesSamplesAndHealthAsJson) {
  const TemporaryFolder folder;
  const LiveEmulator stand({"mark10", "--clock", "virtual", "--tissue", "none"});
  const Ended ended = palpate(
      folder.path(), {"device", "monitor", "mark10:" + stand.port(), "--seconds", "0.6", "--json"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const auto objects = objects_in(ended.out);
  ASSERT_GE(objects.size(), 2u) << ended.out;
  EXPECT_EQ(objects.front()["event"], "sample");
  EXPECT_TRUE(objects.front()["force_N"].is_number());
  EXPECT_EQ(objects.back()["event"], "monitor");
  EXPECT_GT(objects.back()["samples"]["fresh"], 3);
  EXPECT_EQ(objects.back()["id"], "EMULATOR");
}

TEST(DeviceMonitor, PlaysARecording) {
  const TemporaryFolder folder;
  write_file(folder / "run.csv", "time_s,travel_mm,force_N\n0,0,0\n0.05,1,0.5\n0.1,2,1.5\n");
  const Ended ended = palpate(folder.path(), {"device", "monitor", "replay:run.csv"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(has(ended.out, "position 0 0 -2 mm, force 1.5 N")) << ended.out;
}

TEST(DeviceErrors, AreSentencesWithTheirExitCodes) {
  const TemporaryFolder folder;
  const Ended nowhere = palpate(folder.path(), {"device", "probe", "mark10:/dev/no-such-port"});
  EXPECT_EQ(nowhere.code, 6);
  EXPECT_TRUE(has(nowhere.err, "palpate: the port `/dev/no-such-port` is not there"))
      << nowhere.err;
  const Ended unknown = palpate(folder.path(), {"device", "probe", "mark11:/dev/ttyUSB0"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(has(unknown.err, "did you mean `mark10:`")) << unknown.err;
  EXPECT_EQ(palpate(folder.path(), {"device", "prob", "x"}).code, 2);
  EXPECT_EQ(palpate(folder.path(), {"device", "probe", "replay:none.csv"}).code, 2);
}

// Replies without a position come at their pace and are no samples.
TEST(DeviceErrors, ALinkThatGivesNoSampleDoesNotWork) {
  const TemporaryFolder folder;
  const ScratchFile script("[[fault]]\nat = \"0 s\"\nkind = \"missing_field\"\nreplies = 100000\n");
  const LiveEmulator arm({"inverse3", "--clock", "virtual", "--fault", script.path()});
  const Ended ended = palpate(folder.path(), {"device", "probe", arm.arm_link()});
  EXPECT_EQ(ended.code, 6);
  EXPECT_TRUE(has(ended.err, "0 samples of ")) << ended.err;
  EXPECT_TRUE(has(ended.err, "a reply held no position")) << ended.err;
}

TEST(DeviceErrors, AnUnpluggedStandIsALostLink) {
  const TemporaryFolder folder;
  const ScratchFile script("[[fault]]\nat = \"1 s\"\nkind = \"unplug\"\n");
  const LiveEmulator stand({"mark10", "--clock", "virtual", "--fault", script.path()});
  const Ended ended =
      palpate(folder.path(), {"device", "monitor", "mark10:" + stand.port(), "--seconds", "20"});
  EXPECT_EQ(ended.code, 6);
  EXPECT_TRUE(has(ended.err, "the device hung up")) << ended.err;
}

TEST(DeviceErrors, AnInterruptedMonitorEndsWithItsCounts) {
  const TemporaryFolder folder;
  const ScratchFile log("");
  const LiveEmulator arm({"inverse3", "--log", log.path()});
  Running monitor({.arguments = {"device", "monitor", arm.arm_link(), "--seconds", "60"},
                   .folder = folder.path()});
  ASSERT_TRUE(monitor.until([&] { return has(log.text(), "probe_position"); }));
  monitor.send(SIGINT);
  const Ended ended = monitor.wait();
  EXPECT_EQ(ended.code, 130);
}

}  // namespace
}  // namespace palpate::test
