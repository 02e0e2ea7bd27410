// Patterns of a gauge's lines: what is read, what is refused, and what a message says of it.
#include "device/line_gauge.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::device {
namespace {

std::string read(const std::string& pattern, const std::string& line,
                 LinePattern::Decimal decimal = LinePattern::Decimal::point) {
  const auto words = LinePattern(pattern, decimal).match(line);
  if (!words) return "none";
  std::string text;
  for (std::size_t i = 0; i < measures; ++i) {
    if (!words->number[i]) continue;
    text += (text.empty() ? "" : "; ") + std::to_string(*words->number[i]).substr(0, 7);
    if (!words->unit[i].empty()) text += " " + std::string(words->unit[i]);
  }
  return text;
}

TEST(LinePattern, ReadsWhatGaugesSend) {
  EXPECT_EQ(read("{force} {force_unit}", "-18.78 lbF"), "-18.780 lbF");
  EXPECT_EQ(read("{force} {force_unit}", "  1.5N "), "1.50000 N");
  EXPECT_EQ(read("{time},{force},{travel}", "1200,10.35,0.52"), "10.3500; 0.52000; 1200.00");
  EXPECT_EQ(read("{any},{force} {force_unit}", "ST,+00012.34  g"), "12.3400 g");
  EXPECT_EQ(read("{any} {force} {force_unit} {any}", "N     -   12.340 g stable"), "-12.340 g");
  EXPECT_EQ(read("F{force} S{travel}", "F-3 S200"), "-3.0000; 200.000");
  EXPECT_EQ(read("{{\"f\":{force}}}", "{\"f\":1e-2}"), "0.01000");
  EXPECT_EQ(read("{force}", "1,25", LinePattern::Decimal::comma), "1.25000");
  EXPECT_EQ(read("Reading: {force} {force_unit}", "Reading:\t.5 kg"), "0.50000 kg");
}

// Some gauges send the sign as a digit, apart from the number.
TEST(LinePattern, ReadsASignOfItsOwn) {
  const std::string pattern = "41{force_unit}{force_sign}{force}";
  EXPECT_EQ(read(pattern, "41N00012.5"), "12.5000 N");
  EXPECT_EQ(read(pattern, "41N10012.5"), "-12.500 N");
  EXPECT_EQ(read(pattern, "41N20012.5"), "none");
  EXPECT_EQ(read("{force} {force_sign}", "12.5 -"), "-12.500");
  EXPECT_EQ(read("{force} {force_sign}", "12.5"), "none");
  EXPECT_THROW(LinePattern("{force_sign}{force}{force_sign}"), std::invalid_argument);
}

// A doubtful line is not read: a cut or glued number, two numbers in one, or words for a number.
TEST(LinePattern, RefusesSpoiltLines) {
  for (const char* line : {"", "N", "1.2.3 N", "1.5", "1.5 N1.5 N", "nan N", "inf N", "1e308 N",
                           "1.5 N x", "--1.5 N", "1.5 Newtons_", "1.5 abcdefgh", "1.5- N", "0x1 N",
                           "12345678901234567 N", "1e N 2", "\xf8\x80 N", "1,5 N"})
    EXPECT_EQ(read("{force} {force_unit}", line), "none") << line;
  EXPECT_EQ(read("{any}{force} N", "1.2.3 N"), "none");  // not 2.3
  EXPECT_EQ(read("{any}{force} N", "3-1.2 N"), "none");
  EXPECT_EQ(read("{time},{force},{travel}", "1200,10.351300,10.35,0.52"), "none");  // glued
  EXPECT_EQ(read("{force}{any}", "1.2.3"), "none");
  EXPECT_EQ(read("{force}", std::string("1\0", 2)), "none");
}

TEST(LinePattern, TellsWhatALineLacks) {
  const LinePattern pattern("F {force} {force_unit}");
  EXPECT_EQ(pattern.why_not("F 1.5 7"), "`{force_unit}` was expected at `7`");
  EXPECT_EQ(pattern.why_not("F ovf"), "`{force}` was expected at `ovf`");
  EXPECT_EQ(pattern.why_not("F 1.5 N!"), "the end of the line was expected at `!`");
  EXPECT_EQ(pattern.why_not("F 1.5"), "`{force_unit}` was expected where the line ends");
}

TEST(LinePattern, IsRefusedInASentence) {
  const auto refusal = [](const char* text) {
    try {
      const LinePattern pattern(text);
      return std::string("accepted");
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  for (const auto& [text, part] : std::vector<std::pair<const char*, const char*>>{
           {"", "wants `{force}`"},
           {"{travel}", "wants `{force}`"},
           {"{force", "wants `}` after `{force`"},
           {"force}", "wants `{` before `}`"},
           {"{weight}", "got `{weight}`"},
           {"{force} {force}", "wants `{force}` once"},
           {"{force}{travel}", "between `{force}` and `{travel}`"},
           {"{any}{any}{force}", "between `{any}` and `{any}`"}})
    EXPECT_NE(refusal(text).find(part), std::string::npos) << text << ": " << refusal(text);
  EXPECT_EQ(refusal("{any}{force} {force_unit}"), "accepted");
}

TEST(LineUnits, AreExactByDefinition) {
  EXPECT_DOUBLE_EQ(*unit_of(Measure::force, "g"), 9.80665e-3);
  EXPECT_DOUBLE_EQ(*unit_of(Measure::force, "lbf"), 4.4482216152605);
  EXPECT_DOUBLE_EQ(*unit_of(Measure::force, "mN"), 1e-3);
  EXPECT_EQ(unit_of(Measure::force, "LB"), unit_of(Measure::force, "lb"));
  EXPECT_EQ(unit_of(Measure::force, "KGF"), unit_of(Measure::force, "kgf"));
  EXPECT_DOUBLE_EQ(*unit_of(Measure::travel, "in"), 25.4e-3);
  EXPECT_DOUBLE_EQ(*unit_of(Measure::time, "us"), 1e-6);
  for (const char* word : {"", "kp", "MN", "n", "mm"}) EXPECT_FALSE(unit_of(Measure::force, word));
}

}  // namespace
}  // namespace palpate::device
