// The stand's and the gauge's words, by the examples of their guides, and what is none of them.
#include "device/mark10_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "device/serial_port.h"

namespace palpate::device::mark10 {
namespace {

std::vector<std::string> lines_of(LineBuffer& buffer, std::string_view bytes) {
  buffer.feed(bytes);
  std::vector<std::string> lines;
  while (const auto line = buffer.next()) lines.emplace_back(*line);
  return lines;
}

TEST(Mark10Lines, EndWithCrLfHoweverTheyArrive) {
  LineBuffer buffer;
  EXPECT_EQ(lines_of(buffer, "-18.78 lbF\r\n2.00 mm\r\n"),
            (std::vector<std::string>{"-18.78 lbF", "2.00 mm"}));
  EXPECT_EQ(lines_of(buffer, "0.1"), std::vector<std::string>{});
  EXPECT_EQ(buffer.rest(), "0.1");
  EXPECT_EQ(lines_of(buffer, "2 N\r"), std::vector<std::string>{"0.12 N"});
  EXPECT_EQ(lines_of(buffer, "\n\r\n\n 3 N \n"), std::vector<std::string>{"3 N"});
  buffer.feed("half");
  buffer.clear();
  EXPECT_EQ(lines_of(buffer, "1 N\n"), std::vector<std::string>{"1 N"});
}

TEST(Mark10Lines, KeepTheNewestOfTooMuch) {
  LineBuffer buffer;
  buffer.feed(std::string(5000, 'x'));
  EXPECT_EQ(buffer.dropped(), 5000u - 1024u);
  const auto lines = lines_of(buffer, "\n1 N\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "1 N");
  for (const std::string& line : lines) EXPECT_LE(line.size(), 160u);
}

struct Reading {
  const char* line;
  double newtons;
};
class Mark10Readings : public testing::TestWithParam<Reading> {};

TEST_P(Mark10Readings, AreConvertedToNewton) {
  const auto quantity = parse_quantity(GetParam().line);
  ASSERT_TRUE(quantity);
  const auto force = newtons(*quantity);
  ASSERT_TRUE(force);
  EXPECT_DOUBLE_EQ(*force, GetParam().newtons);
}

// By definition 1 lbf = 4.4482216152605 N, 1 kgf = 9.80665 N; NIST SP 811, B.8.
INSTANTIATE_TEST_SUITE_P(Units, Mark10Readings,
                         testing::Values(Reading{"-18.78 lbF", -18.78 * 4.4482216152605},
                                         Reading{"1.5 N", 1.5}, Reading{"+1.5 N", 1.5},
                                         Reading{"250 mN", 0.25}, Reading{"0.002 kN", 2.0},
                                         Reading{"1 kgF", 9.80665}, Reading{"100 gF", 0.980665},
                                         Reading{"16 ozF", 4.4482216152605}, Reading{"1.000N", 1.0},
                                         Reading{"1.000 LBF", 4.4482216152605},
                                         Reading{".5 N", 0.5}));

TEST(Mark10Readings, OfTravelAndSpeed) {
  EXPECT_DOUBLE_EQ(*metres(*parse_quantity("-7.52 mm")), -7.52e-3);
  EXPECT_DOUBLE_EQ(*metres(*parse_quantity("1.000 in")), 25.4e-3);
  EXPECT_FALSE(metres(*parse_quantity("1 N")));
  EXPECT_FALSE(newtons(*parse_quantity("1 mm")));
  EXPECT_DOUBLE_EQ(*metres_per_second(*parse_quantity("60.0 mm/min")), 1e-3);
  EXPECT_DOUBLE_EQ(*metres_per_second(*parse_quantity("60.0")), 1e-3);
  EXPECT_FALSE(metres_per_second(*parse_quantity("60.0 N")));
}

TEST(Mark10Readings, AreRefusedWhereTheyAreNotSurelyOne) {
  for (const char* line : {"", " ", "N", "-", ".", "1.2.3 N", "1,5 N", "0x1p3 N", "nan N", "inf N",
                           "1e308 N", "1 N2 mm", "1.00 N 2.00 mm", "--1 N", "1 N\x01",
                           "12345678901234567 N", "+ 1 N", "1 newtons!", "1 abcdefgh"})
    EXPECT_FALSE(parse_quantity(line)) << line;
}

TEST(Mark10Errors, AreTheGuidesFour) {
  EXPECT_EQ(parse_error("*10"), 10);
  EXPECT_EQ(parse_error("*22"), 22);
  EXPECT_FALSE(parse_error("*1"));
  EXPECT_FALSE(parse_error("10"));
  EXPECT_FALSE(parse_error("*1x"));
  EXPECT_EQ(error_text(22), "a value that is too large");
}

TEST(Mark10Settings, AsTheGuideListsThem) {
  const auto older = parse_settings("V1.00;LBF;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;MIT;POL;B0");
  ASSERT_TRUE(older);
  EXPECT_EQ(older->version, "V1.00");
  EXPECT_EQ(older->unit, "LBF");
  EXPECT_EQ(older->mode, "CUR");
  EXPECT_EQ(older->auto_output, 0);
  EXPECT_EQ(older->sign, Settings::Sign::compression_positive);
  const auto newer = parse_settings("V1.00;N;PC;FLTC3;FLTP1;AOUT25;AOFF5;NUM;IPOL1;OPOL0;B0");
  ASSERT_TRUE(newer);
  EXPECT_EQ(newer->unit, "N");
  EXPECT_EQ(newer->mode, "PC");
  EXPECT_EQ(newer->auto_output, 25);
  EXPECT_TRUE(newer->numbers_only);
  EXPECT_EQ(newer->sign, Settings::Sign::tension_positive);
  EXPECT_EQ(parse_settings("V1;N;CUR;FLTC3;AOUT0;IPOL0;OPOL1")->sign, Settings::Sign::omitted);
  EXPECT_EQ(parse_settings("V1;N;CUR;FLTC3;AOUT0;IPOL0")->sign_listed, true);
  EXPECT_EQ(parse_settings("V1;N;CUR;FLTC3;AOUT0")->sign_listed, false);
  EXPECT_FALSE(parse_settings("1.00 N"));
  EXPECT_FALSE(parse_settings(";;;;;;"));
}

TEST(Mark10Status, InAnyLayout) {
  using Moving = Status::Moving;
  for (const char* text : {"SL", "S L", "S,L", "LS"}) {
    const auto status = parse_status(text);
    ASSERT_TRUE(status) << text;
    EXPECT_EQ(status->moving, Moving::stopped) << text;
    EXPECT_EQ(status->mode, 'L') << text;
  }
  EXPECT_EQ(parse_status("U")->moving, Moving::up);
  EXPECT_EQ(parse_status("D M")->moving, Moving::down);
  const auto at_end = parse_status("SLDL");
  EXPECT_EQ(at_end->moving, Moving::stopped);
  EXPECT_EQ(parse_status("S L UL")->mode, 'L');
  // Up in limit mode, or at the upper limit: the guide's words do not tell them apart.
  EXPECT_EQ(parse_status("UL")->moving, Moving::unknown);
  for (const char* text : {"", "1.00 mm", "X", "S!", "stopped", " "})
    EXPECT_FALSE(parse_status(text)) << text;
}

TEST(Mark10Pairs, AreAForceDirectlyFollowedByATravel) {
  PairReader reader;
  EXPECT_FALSE(reader.take("0.100 N").pair);
  EXPECT_FALSE(reader.take("0.250 N").pair);  // automatic output before it
  const auto step = reader.take("-1.50 mm");
  ASSERT_TRUE(step.pair);
  EXPECT_DOUBLE_EQ(step.pair->force, 0.25);
  EXPECT_DOUBLE_EQ(step.pair->travel, -1.5e-3);
  EXPECT_STREQ(step.pair->force_unit.data(), "N");
}

TEST(Mark10Pairs, AreAlsoATravelDirectlyFollowedByAForce) {
  PairReader reader;
  EXPECT_FALSE(reader.take("-1.50 mm").pair);
  const auto step = reader.take("0.250 N");
  ASSERT_TRUE(step.pair);
  EXPECT_DOUBLE_EQ(step.pair->force, 0.25);
  EXPECT_DOUBLE_EQ(step.pair->travel, -1.5e-3);
  EXPECT_EQ(reader.order(), PairReader::Order::travel_first);
  // The order is that of the first pair: a force with the travel of the next reply is no pair.
  EXPECT_FALSE(reader.take("0.300 N").pair);
  EXPECT_FALSE(reader.take("-1.60 mm").pair);
  EXPECT_TRUE(reader.take("0.310 N").pair);
}

TEST(Mark10Pairs, AreNoneWhereOneLineIsSpoilt) {
  PairReader reader;
  EXPECT_FALSE(reader.take("0.1 N").pair);
  ASSERT_TRUE(reader.take("1.00 mm").pair);  // the stand's order
  const auto fault_of = [&](const char* first, const char* second) {
    reader.clear();
    const Fault fault = reader.take(first).fault;
    const auto step = reader.take(second);
    EXPECT_FALSE(step.pair) << first << " " << second;
    return fault != Fault::none ? fault : step.fault;
  };
  EXPECT_EQ(fault_of("0.1", "1.00 mm"), Fault::garbage);           // truncated
  EXPECT_EQ(fault_of("0.1 N1.00 mm", "1.00 mm"), Fault::garbage);  // glued
  EXPECT_EQ(fault_of("1.00 mm", "0.100 N"), Fault::truncated);     // in the wrong order
  EXPECT_EQ(fault_of("*10", "1.00 mm"), Fault::error_reply);
  EXPECT_EQ(fault_of("OVERLOAD", "1.00 mm"), Fault::overload);
  EXPECT_EQ(fault_of("0.1 stone", "1.00 mm"), Fault::garbage);
  EXPECT_EQ(fault_of("0.1 N", "1.00 furlong"), Fault::garbage);
  // A spoilt line between them is no direct succession.
  reader.clear();
  EXPECT_FALSE(reader.take("0.1 N").pair || reader.take("??").pair || reader.take("1 mm").pair);
}

std::string text(const std::optional<Command>& command) {
  return command ? std::string(command->text()) : "none";
}

TEST(Mark10Commands, HaveTheGuidesForm) {
  EXPECT_EQ(text(speed_command(200.3e-3 / 60.0)), "e0200.3");
  EXPECT_EQ(text(speed_command(1100e-3 / 60.0)), "e1100.0");
  EXPECT_EQ(text(speed_command(0.5e-3 / 60.0)), "e0000.5");
  EXPECT_EQ(text(lower_limit_command(-7.52e-3)), "g-007.52");
  EXPECT_EQ(text(upper_limit_command(7.52e-3)), "h007.52");
  EXPECT_EQ(text(upper_limit_command(-0.001e-3)), "h000.00");  // no sign without a number
  EXPECT_EQ(text(upper_limit_command(999.99e-3)), "h999.99");
}

TEST(Mark10Commands, AreNoneWhereTheFormCannotHoldTheNumber) {
  const double nan = std::nan("");
  for (const double speed : {0.0, -1e-3, 1e-7, 10.0, nan, double{INFINITY}})
    EXPECT_EQ(text(speed_command(speed)), "none") << speed;
  for (const double travel : {1.0, -1.0, 0.999996, nan, double{-INFINITY}, 1e300})
    EXPECT_EQ(text(lower_limit_command(travel)), "none") << travel;
}

TEST(Mark10Garbage, IsToldFromText) {
  EXPECT_EQ(garbage_share("0.100 N\r\n"), 0.0);
  EXPECT_EQ(garbage_share(""), 0.0);
  EXPECT_GT(garbage_share("\xf8\x80\x00\x9a a"), 0.5);
}

}  // namespace
}  // namespace palpate::device::mark10
