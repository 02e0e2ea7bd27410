// Gauges on a serial line as programs: probed, recorded with and without travel, and spoilt.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/text.h"
#include "live_emulator.h"
#include "live_session.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

// The emulated hand of scenarios/emulator/gauge_*.toml reaches the surface, 2 mm below its start,
// after 1 s. A sketch's lines come every 0.1 s, and the first is that of the greeting.
constexpr double line_every = 0.1;     // s
constexpr double touched_after = 1.0;  // s

struct Gauge {
  std::string style = "hx711";
  std::string settings = "hx711";
  std::string baud = "57600";
  std::string clock = "virtual";
  std::string hand = {};  // a file; empty: that of the style
  std::vector<std::string> emulator = {};
};

std::vector<std::string> emulator_of(const Gauge& gauge, const std::string& log) {
  const std::string shipped = project_file("scenarios/emulator/gauge_" + gauge.style + ".toml");
  std::vector<std::string> words{"gauge",
                                 "--clock",
                                 gauge.clock,
                                 "--baud",
                                 gauge.baud,
                                 "--gauge",
                                 gauge.hand.empty() ? shipped : gauge.hand,
                                 "--tissue",
                                 project_file("scenarios/emulator/stand_tissue.toml"),
                                 "--log",
                                 log};
  if (gauge.style == "mark10") words.insert(words.end(), {"--tick", "50 ms"});
  if (gauge.style == "balance") words.insert(words.end(), {"--tick", "200 ms"});
  words.insert(words.end(), gauge.emulator.begin(), gauge.emulator.end());
  return words;
}

std::string link_of(const Gauge& gauge, const LiveEmulator& emulator) {
  return "serial:" + emulator.port() + "," +
         project_file("scenarios/gauges/" + gauge.settings + ".toml");
}

class GaugeRun {
 public:
  explicit GaugeRun(const Gauge& gauge) {
    LiveEmulator emulator(emulator_of(gauge, folder_ / "log.csv"));
    ended = palpate(folder_.path(), {"run", project_file("scenarios/device_stand.toml"), "--device",
                                     link_of(gauge, emulator), "--surface", "-2 mm", "--clock",
                                     gauge.clock, "--set", "output.figures=false"});
    emulator.end();
    const fs::path result = folder_.path() / "out/device_stand";
    for (const char* name : {"force_indentation.csv", "force_time.csv"})
      if (fs::exists(result / name)) rows = Rows(record::read_csv((result / name).string()));
    if (fs::exists(result / "device_health.json"))
      health = nlohmann::json::parse(read_file(result / "device_health.json"));
    log = Rows(record::read_csv((folder_ / "log.csv").string()));
  }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

  // The true force when the emulator sent the line of a row, N.
  [[nodiscard]] double true_force(std::size_t row) const {
    const double time = rows.number(row, "time_s") + 2.0 * line_every;
    for (std::size_t i = 0; i < log.size(); ++i)
      if (log.word(i, "kind") == "out" && std::abs(log.number(i, "time_s") - time) < 1e-3)
        return log.number(i, "force_N");
    return std::nan("");
  }
  [[nodiscard]] double largest_error() const {
    double most = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row)
      most = std::max(most, std::abs(rows.number(row, "measured_force_N") - true_force(row)));
    return most;
  }

  Ended ended;
  nlohmann::json health;
  Rows rows;
  Rows log;

 private:
  TemporaryFolder folder_;
};

TEST(GaugeProbe, ShowsTheLinesAndWhatTheySay) {
  const TemporaryFolder folder;
  const Gauge sketch;
  const LiveEmulator emulator(emulator_of(sketch, folder / "log.csv"));
  const Ended ended = palpate(folder.path(), {"device", "probe", link_of(sketch, emulator)});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* part : {"gauge on a serial line", "lines like `{time},{force},{travel}`",
                           "line      `", ": force ", "height -", "time "})
    EXPECT_TRUE(has(ended.out, part)) << part << "\n" << ended.out;
}

TEST(GaugeProbe, SaysWhyNoLineIsRead) {
  const TemporaryFolder folder;
  const auto refusal = [&](const Gauge& gauge) {
    const LiveEmulator emulator(emulator_of(gauge, folder / "log.csv"));
    // The example's settings, but with less patience.
    std::string text = read_file(project_file("scenarios/gauges/" + gauge.settings + ".toml"));
    if (const auto wait = text.find("\nwait "); wait != std::string::npos)
      text.erase(wait + 1, text.find('\n', wait + 1) - wait);
    const std::string settings = folder.file("gauge.toml", "wait = \"1.5 s\"\n" + text);
    const Ended ended =
        palpate(folder.path(), {"device", "probe", "serial:" + emulator.port() + "," + settings});
    EXPECT_EQ(ended.code, 6);
    return ended.err;
  };
  const std::string other_rate = refusal({.baud = "9600"});
  EXPECT_TRUE(has(other_rate, "garbage comes, as at a wrong rate")) << other_rate;
  const std::string other_words = refusal({.settings = "mark10_gauge", .baud = "115200"});
  EXPECT_TRUE(has(other_words, "no line matches `{force} {force_unit}`")) << other_words;
  EXPECT_TRUE(has(other_words, "`{force_unit}` was expected at `,")) << other_words;
  const std::string silent = refusal({.style = "mark10", .baud = "57600"});
  EXPECT_TRUE(has(silent, "nothing comes within 1.5 s")) << silent;
}

// Live and offline: the model along the measured travel, and the programme without a device.
TEST(GaugeRun, AgreesWithTheOfflineRunToItsResolution) {
  const GaugeRun live{Gauge{}};
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  ASSERT_GE(live.rows.size(), 35u);
  ASSERT_EQ(palpate(live.folder(), {"run", project_file("scenarios/device_stand.toml"), "--out",
                                    "offline", "--set", "output.figures=false"})
                .code,
            0);
  const Rows offline(
      record::read_csv((live.folder() / "offline/device_stand/force_indentation.csv").string()));
  const auto force_at = [&](double time) {
    for (std::size_t i = 0; i < offline.size(); ++i)
      if (std::abs(offline.number(i, "time_s") - time) < 1e-3) return offline.number(i, "force_N");
    return 0.0;  // before the contact
  };
  double largest = 0.0;
  for (std::size_t row = 0; row < live.rows.size(); ++row) {
    const double time = live.rows.number(row, "time_s") + 2.0 * line_every - touched_after;
    const double model = live.rows.number(row, "force_N");
    largest = std::max(largest, model);
    // Half of the travel's resolution of 0.01 mm at the greatest slope, 3/2 F/h = 0.27 N/mm.
    EXPECT_NEAR(model, force_at(time), 1.4e-3) << time;
    // The gauge's resolution and noise and its filter, where the emulator's formula holds.
    if (time < 1.95) {
      EXPECT_NEAR(live.rows.number(row, "measured_force_N"), model, 5e-3) << time;
    }
  }
  EXPECT_GT(largest, 0.15);
}

// A gauge that nobody tared: its zero is said and taken out, and the press is not cut off.
TEST(GaugeRun, WithoutTareBeginsAtTheContactToo) {
  const GaugeRun tared{Gauge{.style = "mark10", .settings = "mark10_gauge", .baud = "115200"}};
  const TemporaryFolder folder;
  const std::string fault =
      folder.file("tare.toml", "[[fault]]\nat = \"0 s\"\nkind = \"spike\"\nvalue = \"20 mN\"\n");
  const GaugeRun untared{Gauge{.style = "mark10",
                               .settings = "mark10_gauge",
                               .baud = "115200",
                               .emulator = {"--fault", fault}}};
  ASSERT_EQ(untared.ended.code, 0) << untared.ended.err;
  EXPECT_TRUE(has(untared.ended.err, "the gauge showed 20")) << untared.ended.err;
  EXPECT_FALSE(has(tared.ended.err, "at rest, which is taken out")) << tared.ended.err;
  ASSERT_EQ(untared.rows.size(), tared.rows.size());
  for (std::size_t row = 0; row < tared.rows.size(); ++row) {
    EXPECT_NEAR(untared.rows.number(row, "time_s"), tared.rows.number(row, "time_s"), 0.05);
    // The steps of the display.
    EXPECT_NEAR(untared.rows.number(row, "force_N"), tared.rows.number(row, "force_N"), 4e-3);
  }
}

// Without travel the forces begin with the contact, and the tissue is identified over time.
TEST(GaugeRun, WithoutTravelRecordsForcesThatIdentifyReads) {
  const GaugeRun live{Gauge{.style = "mark10", .settings = "mark10_gauge", .baud = "115200"}};
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  EXPECT_TRUE(has(live.ended.err, "the lines have no travel: forces are recorded over time"))
      << live.ended.err;
  EXPECT_TRUE(has(live.ended.err, "reads them with `--x time_s --origin 0`")) << live.ended.err;
  EXPECT_FALSE(has(live.ended.err, "Peak force")) << live.ended.err;
  const std::string page = read_file(live.folder() / "out/device_stand/report.html");
  EXPECT_TRUE(has(page, "Forces over time, without the model"));
  EXPECT_TRUE(has(page, "<p class=\"big\">Largest measured force 0."));
  EXPECT_FALSE(has(page, "Model, error and what is neglected"));
  EXPECT_TRUE(has(page, "A live run follows its device"));
  for (const char* of_a_model : {"no result", "Peak force", "Neglected"})
    EXPECT_FALSE(has(page, of_a_model)) << of_a_model;
  ASSERT_GT(live.rows.size(), 40u);
  EXPECT_NEAR(live.rows.number(0, "time_s"), 0.2, 0.1);  // an eighth of 100 mN, at 2 mm/s
  const Ended identified =
      palpate(live.folder(),
              {"identify", "out/device_stand/force_time.csv",
               project_file("scenarios/device_stand.toml"), "--x", "time_s", "--y", "force_N",
               "--json", "--origin", "0", "--unknown", "tissue.young_modulus=2 kPa..60 kPa"});
  ASSERT_EQ(identified.code, 0) << identified.err;
  const std::string name = "\"estimate\":";
  const auto at = identified.out.find(name);
  ASSERT_NE(at, std::string::npos) << identified.out;
  const auto modulus = leading_number(trimmed(identified.out.substr(at + name.size())));
  ASSERT_TRUE(modulus) << identified.out;
  // The emulator's 12 kPa: the start is known to a reading of 50 ms, and the formulas of the two
  // programs differ while the hand withdraws.
  EXPECT_NEAR(modulus->value, 12.0, 0.6);
}

// Noise that hides the press, and a press that never comes: the run says after a few seconds what
// it waits for, and again when its time is up.
TEST(GaugeRun, SaysWhatItWaitsFor) {
  const TemporaryFolder folder;
  const std::string hand = read_file(project_file("scenarios/emulator/gauge_mark10.toml"));
  std::string noisy = hand;
  const auto at = noisy.find("noise ");
  noisy.replace(at, noisy.find('\n', at) - at, "noise = \"600 mN\"");
  const std::string still = hand.substr(0, hand.find("[[waypoint]]"));
  for (const auto& [path, said] :
       {std::pair{folder.file("noisy.toml", noisy), "which is six times the noise of the gauge"},
        std::pair{folder.file("still.toml", still),
                  "100 mN above that at rest, the `start_force` of the settings"}}) {
    const Gauge gauge{
        .style = "mark10", .settings = "mark10_gauge", .baud = "115200", .hand = path};
    LiveEmulator emulator(emulator_of(gauge, folder / "log.csv"));
    const Ended ended = palpate(folder.path(), {"run", project_file("scenarios/device_stand.toml"),
                                                "--device", link_of(gauge, emulator), "--force",
                                                "--clock", "virtual", "--seconds", "10"});
    EXPECT_EQ(ended.code, 6) << ended.err;
    EXPECT_FALSE(has(ended.err, "was not drawn")) << ended.err;
    const auto waiting = ended.err.find("waiting for the force to rise by ");
    const auto never = ended.err.find("the force never rose by ");
    ASSERT_LT(waiting, never) << ended.err;
    EXPECT_TRUE(has(ended.err.substr(waiting, never - waiting), said)) << ended.err;
    EXPECT_TRUE(has(ended.err.substr(never), said)) << ended.err;
    EXPECT_FALSE(has(ended.err, "not drawn")) << "figures without a row\n" << ended.err;
  }
}

// Which was taken for noise: the run waited for ever, and asked for a quieter gauge.
TEST(GaugeRun, WithoutTravelATurnedSignIsSaid) {
  const TemporaryFolder folder;
  const Gauge gauge{.style = "mark10", .settings = "mark10_gauge", .baud = "115200"};
  LiveEmulator emulator(emulator_of(gauge, folder / "log.csv"));
  const std::string settings =
      folder.file("turned.toml", "force_scale = -1\n" +
                                     read_file(project_file("scenarios/gauges/mark10_gauge.toml")));
  const Ended ended =
      palpate(folder.path(), {"run", project_file("scenarios/device_stand.toml"), "--device",
                              "serial:" + emulator.port() + "," + settings, "--clock", "virtual",
                              "--seconds", "10"});
  EXPECT_EQ(ended.code, 6) << ended.err;
  EXPECT_TRUE(has(ended.err, "the force fell by ")) << ended.err;
  EXPECT_TRUE(has(ended.err, "a negative `force_scale`")) << ended.err;
}

// By the machine's clock, interrupted after a second and a half.
TEST(GaugeRun, PollsAreAsOftenAsTheRate) {
  const TemporaryFolder folder;
  const Gauge gauge{
      .style = "mark10", .settings = "mark10_gauge", .baud = "115200", .clock = "real"};
  LiveEmulator emulator(emulator_of(gauge, folder / "log.csv"));
  Running running({.arguments = {"run", project_file("scenarios/device_stand.toml"), "--device",
                                 link_of(gauge, emulator), "--set", "output.figures=false"},
                   .folder = folder.path()});
  const auto start = std::chrono::steady_clock::now();
  (void)running.until(
      [&] { return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(1500); });
  running.send(SIGINT);
  (void)running.wait();
  emulator.end();
  const Rows log(record::read_csv((folder / "log.csv").string()));
  std::vector<double> times;
  for (std::size_t i = 0; i < log.size(); ++i)
    if (log.word(i, "kind") == "out") times.push_back(log.number(i, "time_s"));
  ASSERT_GT(times.size(), 3U);
  // 20 a second; one that was late may be followed by the next in less than its time.
  EXPECT_LE(static_cast<double>(times.size()), 20.0 * (times.back() - times.front()) + 3.0);
}

TEST(GaugeRun, ReadsABalance) {
  const GaugeRun live{Gauge{.style = "balance", .settings = "balance", .baud = "2400"}};
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  ASSERT_GT(live.rows.size(), 10u);
  double largest = 0.0;
  for (std::size_t row = 0; row < live.rows.size(); ++row)
    largest = std::max(largest, live.rows.number(row, "force_N"));
  double most = 0.0;
  for (std::size_t i = 0; i < live.log.size(); ++i)
    most = std::max(most, live.log.number(i, "force_N"));
  EXPECT_NEAR(largest, most, 0.05 * most);  // five readings a second of a force that relaxes
}

// --- faults

struct LineFault {
  const char* kind;
  const char* more;  // keys of its table
  int code;          // of the run
  const char* told;  // in device_health.json; empty: it cannot be told from a good line
  double bound;      // N, of the error of any row's force
};
void PrintTo(const LineFault& fault, std::ostream* out) { *out << fault.kind; }
class GaugeFaults : public testing::TestWithParam<LineFault> {};

// The display's step and noise, and 0.6 ms of its filter at 0.3 N/s.
constexpr double good = 2e-3;  // N

TEST_P(GaugeFaults, AreToldOrBounded) {
  const LineFault& fault = GetParam();
  const ScratchFile script("[[fault]]\nat = \"1.45 s\"\nkind = \"" + std::string(fault.kind) +
                           "\"\n" + fault.more);
  const GaugeRun run{Gauge{.emulator = {"--fault", script.path()}}};
  EXPECT_EQ(run.ended.code, fault.code) << run.ended.err;
  ASSERT_GT(run.rows.size(), 5u) << run.ended.err;
  EXPECT_LE(run.largest_error(), fault.bound);
  const std::string faults = run.health.at("faults").dump();
  if (*fault.told != '\0') {
    EXPECT_TRUE(has(faults, fault.told)) << faults;
  } else {
    EXPECT_EQ(faults, "{}");
  }
  if (fault.code != 0) {
    const bool over = std::string(fault.kind) == "overload";
    EXPECT_TRUE(has(run.ended.err, over ? "the gauge is overloaded" : "the link is lost"))
        << run.ended.err;
    EXPECT_FALSE(has(run.ended.err, "measured and model agree")) << run.ended.err;
  }
}

constexpr const char* no_reply = "bytes came that are no reply";
INSTANTIATE_TEST_SUITE_P(
    All, GaugeFaults,
    testing::Values(
        LineFault{"unplug", "", 6, "the device hung up", good}, LineFault{"stall", "", 6, "", good},
        LineFault{"stall", "duration = \"500 ms\"\n", 0, "", good},
        LineFault{"deaf", "", 0, "", good}, LineFault{"garbage", "", 0, no_reply, good},
        LineFault{"garbage", "replies = 1000\n", 6, no_reply, good},
        LineFault{"truncate", "", 0, no_reply, good}, LineFault{"glue", "", 0, no_reply, good},
        LineFault{"drop", "", 0, "", good}, LineFault{"duplicate", "", 0, "", good},
        LineFault{"echo", "", 0, "", good}, LineFault{"unsolicited", "", 0, no_reply, good},
        LineFault{"nul", "", 0, no_reply, good}, LineFault{"nan", "", 0, no_reply, good},
        LineFault{"huge", "", 0, no_reply, good}, LineFault{"no_travel", "", 0, no_reply, good},
        LineFault{"wrong_unit", "", 0, no_reply, good}, LineFault{"slow", "", 0, "", good},
        LineFault{"wrong_baud", "", 6, no_reply, good}, LineFault{"freeze", "", 6, "", good},
        LineFault{"overload", "", 6, "beyond what the gauge can measure", good},
        LineFault{"clock_jump", "", 6, "the device's own time jumped ahead", good},
        LineFault{"reset", "", 6, "the device's own time went back", good},
        // Lines without a unit cannot show these three: their error is all of the
        // force (0.33 N), twice the force, and what is added.
        LineFault{"unit_change", "", 0, "", 0.35}, LineFault{"sign_flip", "", 0, "", 0.7},
        LineFault{"spike", "value = \"50 mN\"\n", 0, "", 0.05 + good}),
    [](const auto& one) { return std::string(one.param.kind) + std::to_string(one.index); });

// A hand that stops short ends the run, and the verdict says so. What the gauge does while the hand
// stands still is no part of it.
TEST(GaugeRun, EndsWhereTheHandGivesUp) {
  const TemporaryFolder folder;
  std::string hand = read_file(project_file("scenarios/emulator/gauge_hx711.toml"));
  for (auto at = hand.find("\"4 mm\""); at != std::string::npos; at = hand.find("\"4 mm\""))
    hand.replace(at, 6, "\"3.5 mm\"");
  const std::string still = hand.substr(0, hand.rfind("[[waypoint]]"));
  const std::string drift =
      folder.file("drift.toml", "[[fault]]\nkind = \"drift\"\nat = \"2.5 s\"\nvalue = \"5 mN\"\n");
  for (const auto& [path, said] :
       {std::pair{folder.file("back.toml", hand), "was withdrawn after"},
        std::pair{folder.file("still.toml", still), "stands still at"}}) {
    const LiveEmulator emulator(
        emulator_of(Gauge{.hand = path, .emulator = {"--fault", drift}}, folder / "log.csv"));
    const Ended ended =
        palpate(folder.path(), {"run", project_file("scenarios/device_stand.toml"), "--device",
                                link_of(Gauge{}, emulator), "--surface", "-2 mm", "--clock",
                                "virtual", "--set", "output.figures=false", "--force", "--expect"});
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_TRUE(has(ended.err, said)) << ended.err;
    EXPECT_TRUE(has(ended.err, "short press: it ends at 1.5 mm of 2 mm")) << ended.err;
    EXPECT_FALSE(has(ended.err, "; drift: ")) << ended.err;
  }
}

// With units in the lines another unit is converted, and an unknown one is named.
TEST(GaugeUnits, AreConvertedOrNamed) {
  const ScratchFile script(
      "[[fault]]\nat = \"1.4 s\"\nkind = \"unit_change\"\n[[fault]]\nat = \"1.6 s\"\nkind = "
      "\"wrong_unit\"\n");
  const GaugeRun run{Gauge{.style = "mark10",
                           .settings = "mark10_gauge",
                           .baud = "115200",
                           .emulator = {"--fault", script.path()}}};
  EXPECT_EQ(run.ended.code, 0) << run.ended.err;
  const std::string faults = run.health.at("faults").dump();
  EXPECT_TRUE(has(faults, "the device changed its unit")) << faults;
  EXPECT_TRUE(has(faults, "a reading has a unit that is not known")) << faults;
  for (std::size_t row = 1; row < run.rows.size(); ++row)
    EXPECT_LT(std::abs(run.rows.number(row, "force_N") - run.rows.number(row - 1, "force_N")), 0.08)
        << row;  // no jump by the 4.4 of lbF
}

TEST(GaugeErrors, AreSentences) {
  const TemporaryFolder folder;
  const Ended none = palpate(folder.path(), {"device", "probe", "serial:/dev/ttyX,none.toml"});
  EXPECT_EQ(none.code, 2);
  EXPECT_TRUE(has(none.err, "none.toml")) << none.err;
  const Ended stop = palpate(folder.path(), {"device", "stop", "serial:/dev/ttyX,none.toml"});
  EXPECT_EQ(stop.code, 2);
  EXPECT_TRUE(has(stop.err, "wants a device that moves")) << stop.err;
}

}  // namespace
}  // namespace palpate::test
