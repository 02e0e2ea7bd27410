// docs/emulator.md against the program: the faults it lists, its lists of settings.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "base/document.h"
#include "base/fields.h"
#include "base/files.h"
#include "emulator/arm.h"
#include "emulator/files.h"
#include "emulator/line_gauge.h"
#include "emulator/stand.h"
#include "temporary_folder.h"

namespace emulator {
namespace {

std::string manual() { return palpate::read_text(PALPATE_SOURCE_DIR "/docs/emulator.md"); }

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
  const std::size_t both = line_faults().size();
  for (const auto& kinds : {line_faults(), stand_faults().subspan(both),
                            gauge_faults().first(gauge_faults().size() - both), arm_faults()})
    EXPECT_NE(text.find("|---|---|---|\n" + fault_rows(kinds) + "\n"), std::string::npos)
        << fault_rows(kinds);
}

// The fenced block that begins with this line.
std::string block(const std::string& first) {
  const std::string text = manual();
  const auto begin = text.find("```toml\n" + first);
  EXPECT_NE(begin, std::string::npos) << first;
  const auto from = begin + 8;
  return text.substr(from, text.find("```", from) - from);
}

// `table.key` of every key in a file.
std::set<std::string> keys_of(const palpate::Node& file) {
  std::set<std::string> keys;
  for (const palpate::Member& member : file.members) {
    const palpate::Node& value = member.value.kind == palpate::Node::Kind::array &&
                                         !member.value.items.empty() &&
                                         member.value.items[0].kind == palpate::Node::Kind::table
                                     ? member.value.items[0]
                                     : member.value;
    if (value.kind != palpate::Node::Kind::table) keys.insert(member.key);
    for (const palpate::Member& inside : value.members) keys.insert(member.key + "." + inside.key);
  }
  return keys;
}

// The settings as their fields write them, all keys.
template <class Settings>
std::string written(Settings settings) {
  return palpate::fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, settings); },
                                 palpate::Written::all);
}

// The manual's file has every key of the settings, and each has the value that it has without one.
template <class Settings>
void expect_shown(const std::string& text, const Settings& usual, const Settings& read) {
  EXPECT_EQ(keys_of(palpate::parse_toml(text, "manual")),
            keys_of(palpate::parse_toml(written(usual), "fields")));
  EXPECT_EQ(written(read), written(usual));
}

TEST(EmulatorDocs, ShowEveryKeyWithTheValueThatStandsWithoutIt) {
  const palpate::test::TemporaryFolder folder;
  const std::string stand_file = block("# S.toml");
  StandSettings stand;
  read_stand(folder.file("S.toml", stand_file), stand);
  expect_shown(stand_file, StandSettings{}, stand);

  const std::string tissue_file = block("# T.toml");
  expect_shown(tissue_file, TissueSettings{}, read_tissue(folder.file("T.toml", tissue_file)));

  const std::string gauge_file = block("# G.toml");
  LineGaugeSettings gauge;
  read_line_gauge(folder.file("G.toml", gauge_file), gauge);
  ASSERT_EQ(gauge.points.size(), 1U);
  LineGaugeSettings usual_gauge;
  usual_gauge.points = gauge.points;  // none without the file
  expect_shown(gauge_file, usual_gauge, gauge);

  const std::string hand_file = block("# H.toml");
  ArmSettings arm;
  read_hand(folder.file("H.toml", hand_file), arm);
  ASSERT_EQ(arm.hand.waypoints.size(), 1U);
  ArmSettings usual;
  usual.hand.waypoints = arm.hand.waypoints;  // none without the file
  expect_shown(hand_file, usual, arm);
}

TEST(EmulatorSettings, AreRefusedAtTheirPlace) {
  const palpate::test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text, const auto& read) {
    const std::string path = folder.file("f.toml", text);
    try {
      read(path);
      return std::string("accepted");
    } catch (const InputError& refused) {
      return std::string(refused.what()).substr(path.size());
    }
  };
  const auto stand = [&](const std::string& text) {
    StandSettings settings;
    return refusal(text, [&](const std::string& path) { read_stand(path, settings); });
  };
  EXPECT_EQ(
      stand("[gauge]\nfilter = 11\n"),
      ":2:10: `filter` must be at least 0 and at most 10, got `11`; give a value in that range");
  EXPECT_EQ(stand("[gauge]\nunit = \"kN\"\nlist = \"poll\"\n"),
            ":3:8: `list` does not know `poll`; did you mean `pol`? It is one of ipol, pol");
  EXPECT_EQ(stand("[stand]\nlower_end = \"1 mm\"\n"),
            ":2:13: `lower_end` must be below 0 mm, got `1 mm`; give a value in that range");
  EXPECT_EQ(stand("[stand]\nslowest = \"2 m/s\"\nfastest = \"1 m/s\"\n"),
            ":3:11: `fastest` is below `slowest`; give a greater speed");
  EXPECT_EQ(stand("[stand]\npc_control = 1\n"),
            ":2:14: `pc_control` wants `true` or `false`, got an integer `1`; write it as "
            "`pc_control = true`");
  EXPECT_EQ(stand(""), "accepted");
  const auto hand = [&](const std::string& text) {
    ArmSettings settings;
    return refusal(text, [&](const std::string& path) { read_hand(path, settings); });
  };
  EXPECT_EQ(hand("[hand]\nmass = \"1 kPa\"\n"),
            ":2:8: `mass` wants a mass, got `1 kPa`, a pressure; write it as `1 g`");
  EXPECT_EQ(hand("[hand]\nstart = [\"1 mm\", \"2 mm\"]\n"),
            ":2:9: `start` wants a list of 3, got a list of 2; write it as `[..., ..., ...]`");
  EXPECT_EQ(hand("[[waypoint]]\nat = \"1 s\"\n[[waypoint]]\nat = \"1 s\"\n"),
            ":4:6: `at` must be later than that of the waypoint before; give a later time");
}

// A waypoint without a place is where the hand starts; units are those of the whole program.
TEST(EmulatorSettings, AreReadInAnyUnit) {
  const palpate::test::TemporaryFolder folder;
  ArmSettings arm;
  read_hand(
      folder.file("H.toml",
                  "[[waypoint]]\nat = \"100 ms\"\n[hand]\nmass = \"0.2 kg\"\nstiffness = \"0.25 "
                  "N/mm\"\nstart = [\"1 cm\", \"0 um\", \"-2 mm\"]\n"),
      arm);
  EXPECT_EQ(arm.hand.mass, 0.2);
  EXPECT_EQ(arm.hand.stiffness, 250.0);
  ASSERT_EQ(arm.hand.waypoints.size(), 1U);
  EXPECT_EQ(arm.hand.waypoints[0].at, 0.1);
  EXPECT_EQ(arm.hand.waypoints[0].position, (Vec3{0.01, 0.0, -2e-3}));
  StandSettings stand;
  read_stand(folder.file("S.toml",
                         "[stand]\nspeed = \"2 mm/s\"\nfastest = \"0.6 m/min\"\n[gauge]\nunit = "
                         "\"lbF\"\nlist = \"pol\"\n"),
             stand);
  EXPECT_EQ(stand.speed, 2e-3);
  EXPECT_EQ(stand.crosshead.fastest, 0.01);
  EXPECT_EQ(force_units[stand.gauge.unit].symbol, "lbF");
  EXPECT_EQ(stand.list, ListStyle::pol);
}

TEST(EmulatorDocs, ShowAFaultScriptThatIsRead) {
  const palpate::test::TemporaryFolder folder;
  const auto faults = read_faults(folder.file("F.toml", block("[[fault]]")), stand_faults());
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].at, 1'500'000'000);
  EXPECT_EQ(faults[1].replies, 3);
}

}  // namespace
}  // namespace emulator
