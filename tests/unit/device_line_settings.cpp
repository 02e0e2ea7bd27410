// Settings of a gauge: the examples, the defaults, and what is refused with its place.
#include "device/line_settings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace palpate::device {
namespace {

TEST(LineSettings, OfTheExamplesAreRead) {
  const std::string folder = PALPATE_SOURCE_DIR "/scenarios/gauges/";
  const LineSettings sketch = read_line_settings(folder + "hx711.toml");
  EXPECT_EQ(sketch.line.baud, 57600);
  EXPECT_EQ(sketch.start, "t");
  EXPECT_EQ(sketch.force_unit, "g");
  EXPECT_EQ(read_line_settings(folder + "mark10_gauge.toml").poll, "?C\r");
  const LineSettings balance = read_line_settings(folder + "balance.toml");
  EXPECT_EQ(balance.line.data_bits, 7);
  EXPECT_EQ(balance.line.parity, LineFormat::Parity::even);
  EXPECT_DOUBLE_EQ(*balance.start_force, 0.1);
}

TEST(LineSettings, AreRefusedAtTheirPlace) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const std::string path = folder.file("g.toml", text);
    return test::refusal([&] { (void)read_line_settings(path); }).substr(path.size());
  };
  const std::string good = "pattern = \"{force} {force_unit}\"\n";
  EXPECT_EQ(refusal(good + "baud = 12345\n"),
            ":2:8: no serial line has a rate of 12345 baud; write 300, 600, 1200, 2400, 4800, "
            "9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600 or 1000000");
  for (const auto& [text, part] : std::vector<std::pair<std::string, const char*>>{
           {"baud = 9600\n", "`pattern` is missing"},
           {"pattern = \"{force}\"\n", "gives the force no unit; add `force_unit`"},
           {"pattern = \"{force} {force_unit} {travel}\"\n", "add `travel_unit`"},
           {"pattern = \"{force}\"\nforce_unit = \"kp\"\n", "`kp` is no unit of it; write `N`"},
           {good + "force_unit = \"N\"\n", "takes the unit from the lines"},
           {good + "travel_unit = \"mm\"\n", "the pattern has no `{travel}`"},
           {good + "force_scale = 0\n", "makes every force 0"},
           {good + "data_bits = 9\n", "data_bits"},
           {good + "bauds = 9600\n", "bauds"},
           {"pattern = \"{weight}\"\n", "got `{weight}`"},
           {"pattern = \"{force} {force_unit} {travel} {travel_unit}\"\nstart_force = \"1 N\"\n",
            "the lines have a travel"}})
    EXPECT_NE(refusal(text).find(part), std::string::npos) << text << refusal(text);
}

}  // namespace
}  // namespace palpate::device
