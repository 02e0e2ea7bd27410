// docs/emulator.md against the program: the faults it lists, the values it says stand.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "emulator/arm.h"
#include "emulator/mark10.h"
#include "emulator_program.h"

namespace emulator {
namespace {

std::string manual() { return test::read_file(PALPATE_SOURCE_DIR "/docs/emulator.md"); }

std::string fault_rows(std::span<const FaultKind> kinds) {
  std::string rows;
  for (const FaultKind& kind : kinds) {
    const char* life = kind.life == Life::moment    ? "once"
                       : kind.life == Life::replies ? "replies"
                                                    : "lasts";
    (rows += "| `") += kind.name;
    (rows += "` | ") += life;
    ((rows += " | ") += kind.what) += " |\n";
  }
  return rows;
}

TEST(EmulatorDocs, ListEveryFaultAsItIs) {
  const std::string text = manual();
  EXPECT_NE(text.find("|---|---|---|\n" + fault_rows(stand_faults()) + "\n"), std::string::npos)
      << fault_rows(stand_faults());
  EXPECT_NE(text.find("|---|---|---|\n" + fault_rows(arm_faults()) + "\n"), std::string::npos)
      << fault_rows(arm_faults());
}

// The fenced block that begins with this line.
std::string block(const std::string& first) {
  const std::string text = manual();
  const auto begin = text.find("```toml\n" + first);
  EXPECT_NE(begin, std::string::npos) << first;
  const auto from = begin + 8;
  return text.substr(from, text.find("```", from) - from);
}

TEST(EmulatorDocs, ShowTheValuesThatStandWithoutAFile) {
  const test::TemporaryFolder folder;
  StandSettings stand;
  // Each is another than what stands, so that a key which the manual forgets is found.
  stand.crosshead = {.acceleration = 1, .slowest = 1, .fastest = 1, .lower_end = 1, .upper_end = 1};
  stand.gauge = {
      .capacity = 1, .resolution = 1, .noise = 1, .unit = 3, .filter = 9, .peak_filter = 9};
  stand.speed = stand.travel_resolution = 1;
  read_stand(folder.file("S.toml", block("# S.toml")), stand);
  const StandSettings usual;
  EXPECT_DOUBLE_EQ(stand.crosshead.acceleration, usual.crosshead.acceleration);
  EXPECT_DOUBLE_EQ(stand.crosshead.slowest, usual.crosshead.slowest);
  EXPECT_DOUBLE_EQ(stand.crosshead.fastest, usual.crosshead.fastest);
  EXPECT_DOUBLE_EQ(stand.crosshead.lower_end, usual.crosshead.lower_end);
  EXPECT_DOUBLE_EQ(stand.crosshead.upper_end, usual.crosshead.upper_end);
  EXPECT_DOUBLE_EQ(stand.gauge.capacity, usual.gauge.capacity);
  EXPECT_DOUBLE_EQ(stand.gauge.resolution, usual.gauge.resolution);
  EXPECT_DOUBLE_EQ(stand.gauge.noise, usual.gauge.noise);
  EXPECT_EQ(stand.gauge.unit, usual.gauge.unit);
  EXPECT_EQ(stand.gauge.filter, usual.gauge.filter);
  EXPECT_EQ(stand.gauge.peak_filter, usual.gauge.peak_filter);
  EXPECT_DOUBLE_EQ(stand.speed, usual.speed);
  EXPECT_DOUBLE_EQ(stand.travel_resolution, usual.travel_resolution);

  const TissueSettings tissue = read_tissue(folder.file("T.toml", block("# T.toml")));
  const TissueSettings soft;
  EXPECT_DOUBLE_EQ(tissue.E0, soft.E0);
  EXPECT_DOUBLE_EQ(tissue.E_inf, soft.E_inf);
  EXPECT_DOUBLE_EQ(tissue.tau, soft.tau);
  EXPECT_DOUBLE_EQ(tissue.nu, soft.nu);
  EXPECT_DOUBLE_EQ(tissue.R, soft.R);
  EXPECT_DOUBLE_EQ(tissue.surface, soft.surface);

  ArmSettings arm{.idle_after = 1,
                  .force_limit = 1,
                  .device_id = "",
                  .hand = {.mass = 1, .stiffness = 1, .damping = 1, .start = {}}};
  read_hand(folder.file("H.toml", block("# H.toml")), arm);
  const ArmSettings quiet;
  EXPECT_DOUBLE_EQ(arm.hand.mass, quiet.hand.mass);
  EXPECT_DOUBLE_EQ(arm.hand.stiffness, quiet.hand.stiffness);
  EXPECT_DOUBLE_EQ(arm.hand.damping, quiet.hand.damping);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(arm.hand.start[i], quiet.hand.start[i]);
  EXPECT_EQ(arm.device_id, quiet.device_id);
  EXPECT_DOUBLE_EQ(arm.force_limit, quiet.force_limit);
  EXPECT_EQ(arm.idle_after, quiet.idle_after);
  EXPECT_EQ(arm.hand.waypoints.size(), 1U);
}

TEST(EmulatorDocs, ShowAFaultScriptThatIsRead) {
  const test::TemporaryFolder folder;
  const auto faults = read_faults(folder.file("F.toml", block("[[fault]]")), stand_faults());
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].at, 1'500'000'000);
  EXPECT_EQ(faults[1].replies, 3);
}

}  // namespace
}  // namespace emulator
