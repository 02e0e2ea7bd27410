// Recordings: read with places, played the same every time.
#include "device/link.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace palpate::device {
namespace {

TEST(RecordingFile, ReadsATravelOrAPosition) {
  const auto pressed = parse_recording(
      "case,step,time_s,travel_mm,force_N\nskin,1,0,0,0\nskin,1,0.5,1.5,0.25\n\n", "a.csv");
  ASSERT_EQ(pressed.size(), 2u);
  EXPECT_EQ(pressed[1].position, Vec3(0.0, 0.0, -1.5e-3));  // downwards
  EXPECT_EQ(pressed[1].velocity, Vec3(0.0, 0.0, -3e-3));
  EXPECT_EQ(pressed[1].force, 0.25);
  const auto moved =
      parse_recording("position_x_m,time_s,position_z_m,position_y_m\r\n1,0,3,2\r\n", "b.csv");
  EXPECT_EQ(moved[0].position, Vec3(1.0, 2.0, 3.0));
  EXPECT_TRUE(std::isnan(moved[0].force));
}

std::string recording_refusal(const char* text) {
  return test::refusal([&] { return parse_recording(text, "run.csv"); });
}

TEST(RecordingFile, IsRefusedWithItsLine) {
  EXPECT_EQ(
      recording_refusal("travel_mm\n0\n").find("run.csv:1: a recording wants a column `time_s`"),
      0u);
  EXPECT_EQ(recording_refusal("time_s,position_x_m\n0,0\n")
                .find("run.csv:1: a recording wants a position"),
            0u);
  EXPECT_EQ(recording_refusal("time_s,travel_mm\n0,0\n1\n").find("run.csv:3: the row has 1 fields"),
            0u);
  EXPECT_EQ(recording_refusal("time_s,travel_mm\n0,nan\n").find("run.csv:2: `nan` is no finite"),
            0u);
  EXPECT_EQ(recording_refusal("time_s,travel_mm\n0,x\n").find("run.csv:2: `x` is no finite"), 0u);
  EXPECT_EQ(recording_refusal("time_s,travel_mm\n1,0\n0,0\n").find("run.csv:3: `time_s` goes back"),
            0u);
  EXPECT_EQ(recording_refusal("time_s,travel_mm\n").find("run.csv: the recording has no rows"), 0u);
  EXPECT_EQ(recording_refusal("").find("run.csv:1:"), 0u);
}

class RecordingLink : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(path_) << "time_s,travel_mm,force_N\n5,0,0\n5.01,1,0.5\n5.04,2,1\n";
  }
  test::TemporaryFolder folder_;
  std::string path_ = (folder_ / "run.csv").string();
};

TEST_F(RecordingLink, PlaysEachRowOnceAtItsTime) {
  Clock clock(Clock::Kind::stepped);
  clock.sleep_until(100.0);
  Recording recording(path_, clock);
  EXPECT_TRUE(recording.limits().measures_force);
  EXPECT_EQ(recording.sample(0.0).arrival, Arrival::fresh);
  EXPECT_EQ(recording.sample(0.0).arrival, Arrival::none);
  const Sample second = recording.sample(0.02);
  EXPECT_EQ(second.arrival, Arrival::fresh);
  EXPECT_NEAR(second.received, 100.01, 1e-9);  // rounding of 5.01 - 5
  EXPECT_EQ(second.force, 0.5);
  EXPECT_EQ(recording.sample(0.02).arrival, Arrival::none);
  EXPECT_NEAR(clock.now(), 100.03, 1e-9);
  EXPECT_EQ(recording.sample(0.02).arrival, Arrival::fresh);
  const Sample end = recording.sample(0.02);
  EXPECT_EQ(end.arrival, Arrival::lost);
  EXPECT_EQ(end.fault, Fault::recording_ended);
}

TEST_F(RecordingLink, IsTheSameTwice) {
  std::vector<double> times[2];
  for (auto& run : times) {
    Clock clock(Clock::Kind::stepped);
    Recording recording(path_, clock);
    for (Sample one = recording.sample(1.0); one.arrival == Arrival::fresh;
         one = recording.sample(1.0))
      run.push_back(one.received);
  }
  EXPECT_EQ(times[0].size(), 3u);
  EXPECT_EQ(times[0], times[1]);
}

}  // namespace
}  // namespace palpate::device
