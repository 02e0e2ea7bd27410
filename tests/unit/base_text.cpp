// Numbers and words as text.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/text.h"

namespace palpate {
namespace {

using Words = std::vector<std::string>;

RC_GTEST_PROP(Text, NumbersReadBackToTheSameBits, (std::uint64_t pattern)) {
  const auto x = std::bit_cast<double>(pattern);
  RC_PRE(!std::isnan(x));
  const auto back = whole_number(number_text(x));
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::bit_cast<std::uint64_t>(*back) == pattern);
}

TEST(Text, NumbersAreShort) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(3.0), "3");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(1e23), "1e+23");
  EXPECT_EQ(number_text(std::nan("")), "nan");
  EXPECT_EQ(number_text(-std::nan("")), "nan");  // the sign of a NaN says nothing
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(rounded_text(0.123456), "0.1235");
  EXPECT_EQ(rounded_text(123456.0, 2), "120000");
  EXPECT_EQ(rounded_text(-296.4, 2), "-300");
  EXPECT_EQ(rounded_text(1234567.0, 2), "1.2e+06");
  EXPECT_EQ(rounded_text(std::nan("")), "nan");
}

TEST(Text, AnErrorAboveTheWholeHasNoDigits) {
  EXPECT_EQ(error_text(0.0152), "about 1.5 %");
  EXPECT_EQ(error_text(1.0), "about 100 %");
  EXPECT_EQ(error_text(6.34), "more than 100 %");
}

TEST(Text, ALabelWithinASentenceBeginsSmallUnlessItIsASymbol) {
  EXPECT_EQ(within_sentence("Displacement (mm)"), "displacement (mm)");
  EXPECT_EQ(within_sentence("E (kPa)"), "E (kPa)");
  EXPECT_EQ(within_sentence("Young's modulus (kPa)"), "Young's modulus (kPa)");
  EXPECT_EQ(within_sentence("Region 1 Young's modulus"), "region 1 Young's modulus");
  EXPECT_EQ(within_sentence("tissue.young_modulus (kPa)"), "tissue.young_modulus (kPa)");
}

TEST(Text, ALeadingNumberEndsWhereItEnds) {
  EXPECT_EQ(leading_number("11 mm")->value, 11.0);
  EXPECT_EQ(leading_number("11 mm")->rest, " mm");
  EXPECT_EQ(leading_number("+2e-3x")->value, 0.002);
  EXPECT_EQ(leading_number("+2e-3x")->rest, "x");
  EXPECT_TRUE(leading_number("1e400")->out_of_range);
  for (const char* none : {"", "mm", "+", "-", "+-1", "++1", " 1", "e5"})
    EXPECT_FALSE(leading_number(none)) << none;
}

TEST(Text, AWholeNumberHasNothingBehindIt) {
  EXPECT_EQ(whole_number("-1.5"), -1.5);
  for (const char* none : {"", "1 ", "1x", "1e400", "0x10"})
    EXPECT_FALSE(whole_number(none)) << none;
}

TEST(Text, TheNearestWordIsSuggestedWhereOneIsNear) {
  const Words known{"skin", "muscle", "bone", "ligament", "upper_leg"};
  EXPECT_EQ(nearest("skn", known), "skin");
  EXPECT_EQ(nearest("sikn", known), "skin");
  EXPECT_EQ(nearest("musle", known), "muscle");
  EXPECT_EQ(nearest("upperleg", known), "upper_leg");
  EXPECT_EQ(nearest("modulus", std::array<std::string, 2>{"density", "young_modulus"}),
            "young_modulus");
  EXPECT_EQ(nearest("ratio", std::array<std::string, 2>{"poisson_ratio", "instantaneous_ratio"}),
            std::nullopt);
  EXPECT_EQ(nearest("BONE", known), "bone");
  EXPECT_FALSE(nearest("granite", known));
  EXPECT_FALSE(nearest("", known));
  EXPECT_FALSE(nearest("skin", {}));
}

TEST(Text, WithoutANearWordTheOtherRemedyIsTold) {
  const Words known{"skin", "muscle"};
  EXPECT_EQ(did_you_mean("skn", known, "give another"), "did you mean `skin`?");
  EXPECT_EQ(did_you_mean("granite", known, "give another"), "give another");
}

TEST(Text, OfTwoNearWordsCapitalsDecide) {
  EXPECT_EQ(nearest("KPA", Words{"Pa", "kPa"}), "kPa");
  EXPECT_EQ(nearest("mpa", Words{"Pa", "kPa", "MPa"}), "MPa");
}

TEST(Text, WordsAreCutAndJoined) {
  EXPECT_EQ(split("a.b..c", '.'), (Words{"a", "b", "", "c"}));
  EXPECT_EQ(split("", '.'), Words{""});
  EXPECT_EQ(joined(Words{"a", "b"}, ", "), "a, b");
  EXPECT_EQ(joined(Words{}, ", "), "");
  EXPECT_EQ(alternatives(Words{"a", "b", "c"}), "a, b or c");
  EXPECT_EQ(alternatives(Words{"a"}), "a");
  EXPECT_EQ(alternatives(Words{}), "");
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \n"), "");
}

RC_GTEST_PROP(Text, SplitAndJoinedAreInverse, (const std::string& text)) {
  RC_ASSERT(joined(split(text, '.'), ".") == text || text.starts_with('.'));
}

}  // namespace
}  // namespace palpate
