// Quantities as text: every unit, every refusal, and the same bits back.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "base/units.h"

namespace palpate {
namespace {

constexpr std::array units{unit::mm, unit::kPa,        unit::density,  unit::s,
                           unit::ms, unit::per_second, unit::mm_per_s, unit::N};

std::string refusal(std::string_view text, const Unit& wanted) {
  try {
    const double value = parse_quantity(text, wanted);
    return "accepted as " + std::to_string(value);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(Units, EverySymbolAndPrefixHasItsSize) {
  const struct {
    const char* text;
    Unit wanted;
    double si;
  } cases[] = {
      {"1 m", unit::mm, 1.0},
      {"1 mm", unit::mm, 1e-3},
      {"1 cm", unit::mm, 1e-2},
      {"1 dm", unit::mm, 1e-1},
      {"1 um", unit::mm, 1e-6},
      {"1 \u00b5m", unit::mm, 1e-6},
      {"1 \u03bcm", unit::mm, 1e-6},
      {"1 nm", unit::mm, 1e-9},
      {"1 km", unit::mm, 1e3},
      {"1 hm", unit::mm, 1e2},
      {"1 Pa", unit::kPa, 1.0},
      {"1 kPa", unit::kPa, 1e3},
      {"1 hPa", unit::kPa, 1e2},
      {"1 MPa", unit::kPa, 1e6},
      {"1 GPa", unit::kPa, 1e9},
      {"1 mPa", unit::kPa, 1e-3},
      {"1 bar", unit::kPa, 1e5},
      {"1 mbar", unit::kPa, 1e2},
      {"1 N/m^2", unit::kPa, 1.0},
      {"1 N/mm^2", unit::kPa, 1e6},
      {"1 J/m^3", unit::kPa, 1.0},
      {"1 N m^-2", unit::kPa, 1.0},
      {"1 kg/m/s^2", unit::kPa, 1.0},
      {"1 kg/m^3", unit::density, 1.0},
      {"1 g/cm^3", unit::density, 1e3},
      {"1 kg*m^-3", unit::density, 1.0},
      {"1 s", unit::s, 1.0},
      {"1 ms", unit::s, 1e-3},
      {"1 us", unit::s, 1e-6},
      {"1 ns", unit::s, 1e-9},
      {"1 min", unit::s, 60.0},
      {"1 h", unit::s, 3600.0},
      {"1 1/s", unit::per_second, 1.0},
      {"1 Hz", unit::per_second, 1.0},
      {"1 kHz", unit::per_second, 1e3},
      {"1 s^-1", unit::per_second, 1.0},
      {"1 1/ms", unit::per_second, 1e3},
      {"1 mm/s", unit::mm_per_s, 1e-3},
      {"1 m/s", unit::mm_per_s, 1.0},
      {"1 cm/min", unit::mm_per_s, 1e-2 / 60.0},
      {"36 km/h", unit::mm_per_s, 10.0},
      {"1 N", unit::N, 1.0},
      {"1 mN", unit::N, 1e-3},
      {"1 kN", unit::N, 1e3},
      {"1 kg*m/s^2", unit::N, 1.0},
      {"1 J/m", unit::N, 1.0},
      {"1 W s/m", unit::N, 1.0},
      {"1 Pa*m^2", unit::N, 1.0},
  };
  for (const auto& one : cases)
    EXPECT_DOUBLE_EQ(parse_quantity(one.text, one.wanted), one.si) << one.text;
}

TEST(Units, NumbersAreReadAsWritten) {
  EXPECT_EQ(parse_quantity("72.4 kPa", unit::kPa), 72400.0);
  EXPECT_EQ(parse_quantity("1110 kg/m^3", unit::density), 1110.0);
  EXPECT_EQ(parse_quantity("1.7e7 kPa", unit::kPa), 1.7e10);
  EXPECT_EQ(parse_quantity("11mm", unit::mm), 0.011);
  EXPECT_EQ(parse_quantity("  11   mm  ", unit::mm), 0.011);
  EXPECT_EQ(parse_quantity("+3 mm", unit::mm), 0.003);
  EXPECT_EQ(parse_quantity("-3 mm", unit::mm), -0.003);
  EXPECT_EQ(parse_quantity(".5 mm", unit::mm), 0.0005);
}

TEST(Units, EveryRefusalSaysWhatWasWantedAndOneRemedy) {
  const struct {
    const char* text;
    Unit wanted;
    const char* sentence;
  } cases[] = {
      {"", unit::mm, "wants a length, got ``; write it as `1 mm`"},
      {"soft", unit::kPa, "wants a pressure, got `soft`; write it as `1 kPa`"},
      {"+-5 mm", unit::mm, "wants a length, got `+-5 mm`; write it as `1 mm`"},
      {"3", unit::mm, "wants a length with its unit, got `3`; write it as `3 mm`"},
      {"3 kPa", unit::mm, "wants a length, got `3 kPa`, a pressure; write it as `3 mm`"},
      {"3 mm/s", unit::s, "wants a time, got `3 mm/s`, a speed; write it as `3 s`"},
      {"3 m^2", unit::mm, "wants a length, got `3 m^2`, a quantity in m^2; write it as `3 mm`"},
      {"3 m/m", unit::mm, "wants a length, got `3 m/m`, a pure number; write it as `3 mm`"},
      {"60 kpa", unit::kPa,
       "wants a pressure, got `60 kpa` with the unknown unit `kpa`; did you mean `60 kPa`?"},
      {"60 KPA", unit::kPa,
       "wants a pressure, got `60 KPA` with the unknown unit `KPA`; did you mean `60 kPa`?"},
      {"1 kg/m3", unit::density,
       "wants a density, got `1 kg/m3` with the unknown unit `kg/m3`; write it as `1 kg/m^3`"},
      {"10 inches/s", unit::mm_per_s,
       "wants a speed, got `10 inches/s` with the unknown unit `inches/s`; write it as `254 mm/s`"},
      {"2 N/cm2", unit::kPa,
       "wants a pressure, got `2 N/cm2` with the unknown unit `N/cm2`; write it as `20 kPa`"},
      {"1 kg/m\u00b3", unit::density,
       "wants a density, got `1 kg/m\u00b3` with the unknown unit `kg/m\u00b3`; did you mean `1 "
       "kg/m^3`?"},
      {"5 furlongs", unit::mm,
       "wants a length, got `5 furlongs` with the unknown unit `furlongs`; write it as `5 mm`"},
      {"62.4 lb/ft3", unit::density,
       "wants a density, got `62.4 lb/ft3` with the unknown unit `lb/ft3`; write it as "
       "`999.552114535113 kg/m^3`"},
      {"5 mph", unit::mm_per_s,
       "wants a speed, got `5 mph` with the unknown unit `mph`; write it as `2235.2 mm/s`"},
      {"2 inch", unit::mm,
       "wants a length, got `2 inch` with the unknown unit `inch`; write it as `50.8 mm`"},
      {"10 psi", unit::kPa,
       "wants a pressure, got `10 psi` with the unknown unit `psi`; write it as `68.9475729316836 "
       "kPa`"},
      {"2,5 mm", unit::mm,
       "wants a length, got `2,5 mm`; write it with a decimal point, as `2.5 mm`"},
      {"1.000,5 mm", unit::mm,
       "wants a length, got `1.000,5 mm`; write it with a decimal point, as `1000.5 mm`"},
      {"5 mm/", unit::mm,
       "wants a length, got `5 mm/` with the unknown unit `mm/`; did you mean `5 mm`?"},
      {"5 *mm", unit::mm,
       "wants a length, got `5 *mm` with the unknown unit `*mm`; did you mean `5 mm`?"},
      {"nan mm", unit::mm, "wants a length, got `nan mm`; write a finite number, as `1 mm`"},
      {"-inf mm", unit::mm, "wants a length, got `-inf mm`; write a finite number, as `1 mm`"},
      {"1e400 mm", unit::mm,
       "wants a length, got `1e400 mm`, which no double can hold; write a number between 1e-300 "
       "and "
       "1e300 in size"},
      {"1e-400 mm", unit::mm,
       "wants a length, got `1e-400 mm`, which no double can hold; write a number between 1e-300 "
       "and 1e300 in size"},
      {"1e308 GPa", unit::kPa,
       "wants a pressure, got `1e308 GPa`, which no double can hold in SI units; write a smaller "
       "number"},
  };
  for (const auto& one : cases) EXPECT_EQ(refusal(one.text, one.wanted), one.sentence);
  const std::string furlongs(5000, 'f');
  EXPECT_EQ(refusal("5 " + furlongs, unit::mm),
            "wants a length, got `5 " + furlongs + "` with an unknown unit; write it as `5 mm`");
}

TEST(Units, WhatIsNoUnitExpressionIsRefused) {
  for (const char* text :
       {"1 m//s", "1 /s", "1 m^", "1 m^x", "1 m^1.5", "1 m^99", "1 m^1e400", "1 m^nan", "1 kkg",
        "1 kmin", "1 2 mm", "1 (mm)", "1 mm;", "1 1", "1 1/"})
    EXPECT_TRUE(refusal(text, unit::mm).starts_with("wants a length, got")) << text;
}

// Any double: all bit patterns, with those that people write far more often than chance has them.
rc::Gen<double> finite_doubles() {
  const auto bits = rc::gen::suchThat(
      rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                   [](std::uint64_t pattern) { return std::bit_cast<double>(pattern); }),
      [](double x) { return x - x == 0.0; });
  const auto written = rc::gen::map(rc::gen::inRange(-1000000, 1000000),
                                    [](int n) { return static_cast<double>(n) / 1e3; });
  return rc::gen::oneOf(bits, written, rc::gen::cast<double>(rc::gen::inRange(0, 100000)));
}

RC_GTEST_PROP(Units, TextReadsBackToTheSameBits, ()) {
  const double x = *finite_doubles();
  for (const Unit& unit : units) {
    const std::string text = quantity_text(x, unit);
    const double back = parse_quantity(text, unit);
    if (std::bit_cast<std::uint64_t>(back) != std::bit_cast<std::uint64_t>(x))
      RC_FAIL(text + " reads back to another double");
  }
}

TEST(Units, TextReadsBackAtTheEndsOfTheDoubles) {
  using Limits = std::numeric_limits<double>;
  for (const double x :
       {0.0, -0.0, Limits::max(), Limits::lowest(), Limits::min(), Limits::denorm_min(), 1.0 / 3.0})
    for (const Unit& unit : units)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(parse_quantity(quantity_text(x, unit), unit)),
                std::bit_cast<std::uint64_t>(x))
          << x << " " << unit.symbol;
}

TEST(Units, TextIsShortInTheUnitThatWasAskedFor) {
  EXPECT_EQ(quantity_text(0.011, unit::mm), "11 mm");
  EXPECT_EQ(quantity_text(72400.0, unit::kPa), "72.4 kPa");
  EXPECT_EQ(quantity_text(0.0, unit::N), "0 N");
  EXPECT_EQ(quantity_text(1.7e308, unit::mm), "1.7e+308 m");  // in millimetres it is infinite
}

TEST(Units, AFileMayBeInInches) {
  EXPECT_DOUBLE_EQ(metres_per("in"), 0.0254);
  EXPECT_DOUBLE_EQ(metres_per("inch"), 0.0254);
  EXPECT_DOUBLE_EQ(metres_per("mm"), 0.001);
  EXPECT_THROW((void)metres_per("psi"), std::invalid_argument);
}

TEST(Units, AreKnownByWordsInTheSingularAndThePlural) {
  for (const char* hours : {"hour", "Hours", "hr", "hrs"})
    EXPECT_EQ(unit_word(hours)->factor.to_si(1.0), 3600.0) << hours;
  EXPECT_STREQ(unit_word("kilopascals")->symbol, "kPa");
  EXPECT_STREQ(unit_word("kilopascal")->symbol, "kPa");
  for (const char* none : {"s", "ins", "pascalss"}) EXPECT_EQ(unit_word(none), nullptr) << none;
}

TEST(Units, DimensionsHaveNames) {
  EXPECT_EQ(dimension_name(unit::kPa.dimension), "a pressure");
  EXPECT_EQ(dimension_name({}), "a pure number");
  EXPECT_EQ(dimension_name({2, 1, -2}), "a quantity in m^2*kg*s^-2");
}

}  // namespace
}  // namespace palpate
