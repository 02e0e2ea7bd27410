// The loops on live links: they allocate nothing, whatever the link, once they are under way.
#include <gtest/gtest.h>

#include "base/error.h"
#include "counted_memory.h"
#include "live/loop.h"
#include "live_emulator.h"
#include "scenario/family.h"
#include "scene_text.h"

namespace palpate::live {
namespace {

using test::LiveEmulator;

std::string file(const std::string& name) { return std::string(PALPATE_SOURCE_DIR) + "/" + name; }

struct Looped {
  LiveEnd end;
  std::size_t allocations = 0;
  std::size_t rows = 0;
};

Looped loop(const std::string& scenario, const LiveOptions& options,
            const std::vector<std::string>& settings = {}) {
  const scene::Scene scene = test::first_scene(scenario::read(file(scenario), settings));
  device::Clock clock(device::Clock::Kind::stepped);
  device::Link link(options.link, device::Purpose::command, clock);
  LiveModel model(scene);
  device::Health health;
  const std::atomic<bool> stop = false;
  LiveLog log([](int) {});
  LiveLoop all{scene, options, link, clock, model, log, health, stop};
  Looped looped;
  const std::size_t before = test::blocks_taken;
  looped.end = link.identity().kind == device::Kind::stand ? run_stand(all) : run_arm(all);
  looped.allocations = test::blocks_taken - before;
  looped.rows = log.finish().size();
  return looped;
}

LiveOptions options(const std::string& link, double surface) {
  LiveOptions options;
  options.link = link;
  options.act = LiveOptions::Act::command;
  options.clock = device::Clock::Kind::stepped;
  options.surface = surface;
  return options;
}

// As the scenarios stand, and with a mesh in place of the closed form.
class LiveLoops : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(LiveLoops, OfTheArmAllocatesNothing) {
  const LiveEmulator emulator(
      {"inverse3", "--clock", "virtual", "--hand", file("scenarios/emulator/arm_hand.toml")});
  const Looped looped =
      loop("scenarios/device_arm.toml", options(emulator.arm_link(), 0.13), GetParam());
  EXPECT_EQ(looped.end.why, LiveEnd::Why::done) << looped.end.sentence;
  EXPECT_GT(looped.rows, 2500U);
  EXPECT_EQ(looped.allocations, 0U);
}

TEST_P(LiveLoops, OfTheStandAllocatesNothing) {
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", file("scenarios/emulator/stand_tissue.toml")});
  const Looped looped =
      loop("scenarios/device_stand.toml", options("mark10:" + emulator.port(), -2e-3), GetParam());
  EXPECT_EQ(looped.end.why, LiveEnd::Why::done) << looped.end.sentence;
  EXPECT_GT(looped.rows, 140U);
  EXPECT_EQ(looped.allocations, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    ClosedFormAndMesh, LiveLoops,
    testing::Values(std::vector<std::string>(),
                    std::vector<std::string>{
                        R"(tissue.shape={kind="cuboid",size=["40 mm","40 mm","20 mm"]})",
                        R"(tissue.mesh={kind="kuhn",cells=[3,4,6]})", "solver.model=mass_spring",
                        "solver.integrator=quasi_static", R"(solver.time_step="1 ms")"}));

// Also where the hand has gone in since the plan was made.
TEST(LiveLoop, OfTheArmEndsWhereItBeginsInsideTheTissue) {
  const LiveEmulator emulator({"inverse3", "--clock", "virtual"});
  const Looped looped = loop("scenarios/device_arm.toml", options(emulator.arm_link(), 0.16));
  EXPECT_EQ(looped.end.why, LiveEnd::Why::link);
  EXPECT_EQ(looped.end.sentence,
            "the finger was inside the tissue at the start; move it out and begin again, or give "
            "another `--surface`");
  EXPECT_EQ(looped.rows, 1U);
}

}  // namespace
}  // namespace palpate::live
