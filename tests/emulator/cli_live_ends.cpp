// How live runs are refused, and how they end before their programme does.
#include <gtest/gtest.h>

#include "held_run.h"

namespace palpate {
namespace {

using test::has;
using test::Played;
using test::Session;

TEST(LiveRun, RefusesWhatNoDeviceDoes) {
  test::TemporaryFolder folder;
  const std::string stand = test::project_file("scenarios/device_stand.toml");
  const auto said = [&](const std::vector<std::string>& call) {
    const test::Ended ended = test::palpate(folder.path(), call);
    EXPECT_EQ(ended.code, 2) << ended.err;
    return ended.err;
  };
  EXPECT_TRUE(has(said({"run", stand, stand, "--device", "mark10:/dev/none"}), "one scenario"));
  EXPECT_TRUE(has(said({"run", stand, "--device", "mark11:/dev/none"}), "mark10:/dev/ttyUSB0"));
  EXPECT_TRUE(
      has(said({"run", stand, "--device", "mark10:/dev/none", "--surface", "2 N"}), "--surface"));
  EXPECT_TRUE(has(said({"run", stand, "--arm"}), "--device"));
  test::write_file(
      folder / "sweep.toml",
      test::read_file(stand) + "\n[sweep]\n\"tissue.young_modulus\" = [\"12 kPa\", \"13 kPa\"]\n");
  EXPECT_TRUE(has(said({"run", "sweep.toml", "--device", "mark10:/dev/none"}), "2 cases"));
  test::write_file(folder / "slide.toml",
                   test::read_file(stand) + "\n[[step]]\nkind = \"slide\"\nby = \"1 mm\"\n");
  EXPECT_TRUE(has(said({"run", "slide.toml", "--device", "mark10:/dev/none"}), "`slide`"));
  EXPECT_TRUE(has(said({"run", stand, "--device", "replay:none.csv"}), "none.csv"));
  const test::Ended lost =
      test::palpate(folder.path(), {"run", stand, "--device", "mark10:/dev/none"});
  EXPECT_EQ(lost.code, 2 + 4) << lost.err;  // 6: a link
}

// A programme beyond the ceiling is refused before anything moves.
TEST(LiveRun, RefusesAProgrammeBeyondTheCeiling) {
  const Played live(Session{.options = {"--arm", "--max-force", "0.1 N"}});
  EXPECT_EQ(live.ended.code, 2) << live.ended.err;
  EXPECT_TRUE(has(live.ended.err, "beyond the ceiling of 0.1 N")) << live.ended.err;
  EXPECT_EQ(live.summary.at("greatest_force_N"), 0.0);
  EXPECT_FALSE(test::fs::exists(live.result("device_stand")));
}

// Ctrl-C: the stand is told to stop at once, what was measured is kept.
class LiveInterrupt : public testing::TestWithParam<int> {};

TEST_P(LiveInterrupt, StopsTheStandAndKeepsTheRows) {
  const auto held = test::held_press();
  ASSERT_TRUE(held->moves());
  held->send(GetParam());
  const test::Ended ended = held->run().wait();
  EXPECT_EQ(ended.code, 130) << ended.err;
  const auto summary = held->summary();
  EXPECT_EQ(summary.at("moving"), false);
  EXPECT_GT(summary.at("position_m").get<double>(), -3e-3)
      << "it stopped before the end of its way";
  const test::Rows rows(
      record::read_csv((held->folder() / "out/device_stand/force_indentation.csv").string()));
  EXPECT_GT(rows.size(), 2U);
  EXPECT_TRUE(has(ended.err, "rows are kept")) << ended.err;
}
INSTANTIATE_TEST_SUITE_P(Signals, LiveInterrupt, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace palpate
