// What each design of [sweep] makes: which cases, in which order, with which values.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <thread>

#include "base/text.h"
#include "scenario/design.h"
#include "scenario/family.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

Family of(const std::string& sweep) {
  return parse(small_press + "[sweep]\n" + sweep, "press.toml", {});
}

// The word of a key in every case.
std::vector<std::string> words(const Family& family, const std::string& key) {
  std::vector<std::string> all;
  for (const Case& one : family.cases)
    for (const auto& [swept, word] : one.swept)
      if (swept == key) all.push_back(word);
  return all;
}

// The same as numbers, in the unit that they are written in.
std::vector<double> numbers(const Family& family, const std::string& key) {
  std::vector<double> all;
  for (const std::string& word : words(family, key)) all.push_back(leading_number(word)->value);
  return all;
}

std::vector<std::string> names(const Family& family) {
  std::vector<std::string> all;
  for (const Case& one : family.cases) all.push_back(one.name);
  return all;
}

using Words = std::vector<std::string>;

// --- ranges

TEST(Range, EndsAreExactAndStepsEqual) {
  const Family family = of("\"finger.radius\" = { from = \"8 mm\", to = \"11 mm\", points = 7 }\n");
  EXPECT_EQ(names(family),
            (Words{"8 mm", "8.5 mm", "9 mm", "9.5 mm", "10 mm", "10.5 mm", "11 mm"}));
  EXPECT_EQ(family.cases[0].scenario.finger.radius, 0.008);
  EXPECT_EQ(family.cases[3].scenario.finger.radius, 0.0095);
  EXPECT_EQ(family.cases[6].scenario.finger.radius, 0.011);
}

TEST(Range, LogarithmicStepsAreEqualRatios) {
  const Family family =
      of("\"tissue.young_modulus\" = { from = \"1 kPa\", to = \"100 kPa\", points = 5, scale = "
         "\"log\" }\n");
  EXPECT_EQ(names(family),
            (Words{"1 kPa", "3.16227766017 kPa", "10 kPa", "31.6227766017 kPa", "100 kPa"}));
  EXPECT_EQ(family.cases[2].scenario.tissue.young_modulus, 1e4);
}

TEST(Range, OfPureNumbersIsPureNumbers) {
  EXPECT_EQ(names(of("\"contact.friction\" = { from = 0.0, to = 0.5, points = 3 }\n")),
            (Words{"0.0", "0.25", "0.5"}));
  EXPECT_EQ(names(of("\"contact.friction\" = { from = 1, to = 0, points = 3 }\n")),
            (Words{"1", "0.5", "0"}));  // downwards too
  const Family whole = of("\"finger.spheres\" = { from = 1, to = 7, points = 4 }\n");
  EXPECT_EQ(names(whole), (Words{"1", "3", "5", "7"}));
  EXPECT_EQ(whole.cases[2].scenario.finger.spheres, 5);
}

TEST(Range, MayStandWithoutQuotes) {
  EXPECT_EQ(names(of("finger.radius = { from = \"8 mm\", to = \"9 mm\", points = 2 }\n"
                     "step.1.to = [\"0.1 mm\"]\n")),
            (Words{"8 mm_0.1 mm", "9 mm_0.1 mm"}));
  EXPECT_EQ(names(of("step.1.to = { from = \"0.1 mm\", to = \"0.2 mm\", points = 2 }\n")),
            (Words{"0.1 mm", "0.2 mm"}));
}

TEST(Range, OfTheCommandLineReplacesAList) {
  const Family family =
      parse(small_press + "[sweep]\n\"finger.radius\" = [\"8 mm\"]\n", "press.toml",
            {"sweep.finger.radius={ from = \"10 mm\", to = \"11 mm\", points = 2 }"});
  EXPECT_EQ(names(family), (Words{"10 mm", "11 mm"}));
}

// Whatever the ends, neighbours differ, stay between the ends and keep their order.
RC_GTEST_PROP(Range, KeepsItsOrder, ()) {
  const double low = std::exp(1e-6 * *rc::gen::inRange(-5'000'000, 5'000'000));
  const double width = std::exp(1e-6 * *rc::gen::inRange(-9'000'000, 5'000'000));
  const int points = *rc::gen::inRange(2, 60);
  const bool logarithmic = *rc::gen::arbitrary<bool>();
  const Family family =
      of("\"tissue.young_modulus\" = { from = \"" + number_text(low) + " kPa\", to = \"" +
         number_text(low * (1.0 + width)) + " kPa\", points = " + std::to_string(points) +
         ", scale = \"" + (logarithmic ? "log" : "linear") + "\" }\n");
  const std::vector<double> values = numbers(family, "tissue.young_modulus");
  RC_ASSERT(values.size() == static_cast<std::size_t>(points));
  RC_ASSERT(values.front() == low);
  RC_ASSERT(values.back() == low * (1.0 + width));
  for (std::size_t i = 1; i < values.size(); ++i) RC_ASSERT(values[i] > values[i - 1]);
}

// --- grid, list, rows

TEST(Grid, VariesItsLastFactorFastest) {
  const Family family =
      of("\"tissue.poisson_ratio\" = { from = 0.2, to = 0.4, points = 3 }\n"
         "\"tissue.material\" = [\"skin\", \"bone\"]\n");
  EXPECT_EQ(names(family),
            (Words{"0.2_skin", "0.2_bone", "0.3_skin", "0.3_bone", "0.4_skin", "0.4_bone"}));
  EXPECT_EQ(family.design.keys(), (Words{"tissue.poisson_ratio", "tissue.material"}));
}

TEST(Grid, NumbersCasesWhereWordsWouldBeLong) {
  const std::string long_title(81, 'a');
  EXPECT_EQ(names(of("title = [\"" + long_title.substr(1) + "\"]\n")), Words{long_title.substr(1)});
  EXPECT_EQ(names(of("title = [\"" + long_title + "\", \"b\"]\n")), (Words{"0001", "0002"}));
}

TEST(List, TakesTheValuesOfOneRowTogether) {
  const Family family =
      of("design = \"list\"\n\"finger.radius\" = [\"8 mm\", \"9 mm\", \"10 mm\"]\n"
         "\"contact.friction\" = { from = 0.0, to = 1.0, points = 3 }\n");
  EXPECT_EQ(names(family), (Words{"8 mm_0.0", "9 mm_0.5", "10 mm_1.0"}));
  EXPECT_EQ(family.design.factors().size(), 2U);
}

TEST(Rows, ChangeTogetherInAGrid) {
  const Family family =
      of("\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n[[sweep.rows]]\n\"tissue.material\" = "
         "[\"skin\", \"muscle\"]\ntissue.young_modulus = [\"60 kPa\", \"20 kPa\"]\n"
         "[[sweep.rows]]\n\"contact.friction\" = [0.1, 0.2]\n");
  EXPECT_EQ(names(family),
            (Words{"8 mm_skin_60 kPa_0.1", "8 mm_skin_60 kPa_0.2", "8 mm_muscle_20 kPa_0.1",
                   "8 mm_muscle_20 kPa_0.2", "9 mm_skin_60 kPa_0.1", "9 mm_skin_60 kPa_0.2",
                   "9 mm_muscle_20 kPa_0.1", "9 mm_muscle_20 kPa_0.2"}));
  EXPECT_EQ(family.design.keys(), (Words{"finger.radius", "tissue.material", "tissue.young_modulus",
                                         "contact.friction"}));
  ASSERT_EQ(family.design.factors().size(), 3U);
  EXPECT_EQ(family.design.factors()[1].name, "tissue.material + tissue.young_modulus");
  EXPECT_EQ(family.cases[2].scenario.tissue.young_modulus, 2e4);
}

TEST(Rows, OfRangesShareOneCoordinate) {
  const Family family =
      of("design = \"sobol\"\nsamples = 3\n[[sweep.rows]]\n\"tissue.young_modulus\" = { from = "
         "\"10 kPa\", to = \"20 kPa\" }\n\"tissue.density\" = { from = \"1000 kg/m^3\", to = "
         "\"1200 kg/m^3\" }\n");
  EXPECT_EQ(numbers(family, "tissue.young_modulus"), (std::vector<double>{15, 17.5, 12.5}));
  EXPECT_EQ(numbers(family, "tissue.density"), (std::vector<double>{1100, 1150, 1050}));
  EXPECT_EQ(family.design.factors().size(), 1U);
}

// --- samples

// The first points of Joe and Kuo's program for new-joe-kuo-6.21201, three dimensions, as printed
// in its notes (https://web.maths.unsw.edu.au/~fkuo/sobol/joe-kuo-notes.pdf), without the origin.
TEST(Sobol, IsThePublishedSequence) {
  const std::vector<double> published{0.5,    0.5,    0.5,    0.75,   0.25,   0.25,  0.25,
                                      0.75,   0.75,   0.375,  0.375,  0.625,  0.875, 0.875,
                                      0.125,  0.625,  0.125,  0.875,  0.125,  0.625, 0.375,
                                      0.1875, 0.3125, 0.9375, 0.6875, 0.8125, 0.4375};
  EXPECT_EQ(sobol_points(9, 3), published);
}

// Directions by the recurrence of Bratley and Fox (1988) from the table's first lines: degree s,
// inner coefficients a, initial numbers m.
std::vector<double> sobol_by_hand(std::size_t samples) {
  struct Line {
    unsigned s, a;
    std::vector<std::uint32_t> m;
  };
  const std::vector<Line> lines{{0, 0, {}},        {1, 0, {1}},       {2, 1, {1, 3}},
                                {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}};
  std::vector<double> points(samples * lines.size());
  for (std::size_t d = 0; d < lines.size(); ++d) {
    const auto& [s, a, initial] = lines[d];
    std::vector<std::uint32_t> m = initial;
    for (unsigned i = s; i < 20; ++i) {
      if (s == 0) {
        m.push_back(1);
        continue;
      }
      std::uint32_t next = m[i - s] ^ (m[i - s] << s);
      for (unsigned k = 1; k < s; ++k) next ^= ((a >> (s - 1 - k)) & 1U) * (m[i - k] << k);
      m.push_back(next);
    }
    for (std::size_t i = 0; i < samples; ++i) {
      const std::size_t gray = (i + 1) ^ ((i + 1) >> 1);
      std::uint32_t x = 0;
      for (unsigned bit = 0; bit < 20; ++bit)
        if (((gray >> bit) & 1U) != 0) x ^= m[bit] << (31 - bit);
      points[i * lines.size() + d] = std::ldexp(static_cast<double>(x), -32);
    }
  }
  return points;
}

TEST(Sobol, HasTheDirectionsOfTheTable) { EXPECT_EQ(sobol_points(300, 6), sobol_by_hand(300)); }

TEST(Sobol, FillsRangesAndLists) {
  const Family family = of(
      "design = \"sobol\"\nsamples = 7\n\"finger.radius\" = { from = \"8 mm\", to = \"16 mm\" }\n"
      "\"tissue.young_modulus\" = { from = \"1 kPa\", to = \"16 kPa\", scale = \"log\" }\n"
      "\"tissue.material\" = [\"skin\", \"muscle\"]\n");
  EXPECT_EQ(numbers(family, "finger.radius"), (std::vector<double>{12, 14, 10, 11, 15, 13, 9}));
  EXPECT_EQ(numbers(family, "tissue.young_modulus")[0], 4);
  EXPECT_EQ(numbers(family, "tissue.young_modulus")[1], 2);
  EXPECT_EQ(words(family, "tissue.material"),
            (Words{"muscle", "skin", "muscle", "muscle", "skin", "muscle", "skin"}));
  EXPECT_EQ(names(family)[6], "0007");
}

std::vector<std::size_t> strata(const std::vector<double>& points, std::size_t dimensions,
                                std::size_t dimension) {
  const std::size_t samples = points.size() / dimensions;
  std::vector<std::size_t> hit(samples, 0);
  for (std::size_t i = 0; i < samples; ++i)
    ++hit[static_cast<std::size_t>(points[i * dimensions + dimension] *
                                   static_cast<double>(samples))];
  return hit;
}

TEST(LatinHypercube, HitsEachStratumOnce) {
  for (const std::size_t samples : {1U, 2U, 3U, 97U, 1024U}) {
    const std::vector<double> points = latin_hypercube(samples, 3, 11);
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_EQ(strata(points, 3, d), std::vector<std::size_t>(samples, 1)) << samples;
  }
}

TEST(LatinHypercube, DrawsInsideTheStrataAndWithoutCorrelation) {
  constexpr std::size_t samples = 4096;
  const std::vector<double> points = latin_hypercube(samples, 2, 3);
  double inside = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double scaled = points[2 * i] * samples;
    inside += (scaled - std::floor(scaled)) / samples;
    product += 12.0 * (points[2 * i] - 0.5) * (points[2 * i + 1] - 0.5) / samples;
  }
  EXPECT_NEAR(inside, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / samples));  // five standard errors
  EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(samples));              // likewise
}

// From a program of a dozen lines in another language that follows sample_points.h by the letter.
TEST(LatinHypercube, IsTheSameEverywhere) {
  EXPECT_EQ(latin_hypercube(4, 2, 1),
            (std::vector<double>{0.2552560567855835, 0.7723632981069386, 0.5877245282754302,
                                 0.13904472440481186, 0.9778395118191838, 0.697412992361933,
                                 0.11768803279846907, 0.30540841817855835}));
  EXPECT_EQ(latin_hypercube(4, 2, 7),
            (std::vector<double>{0.47297829389572144, 0.4389362586662173, 0.5353178903460503,
                                 0.8990471949800849, 0.013773289509117603, 0.09936136333271861,
                                 0.9581307447515428, 0.5771321789361537}));
}

TEST(LatinHypercube, TakesItsSeedAndDefaultsToOne) {
  const std::string range = "\"finger.radius\" = { from = \"10 mm\", to = \"11 mm\" }\n";
  const auto drawn = [&](const std::string& seed) {
    return words(of("design = \"lhs\"\nsamples = 4\n" + seed + range), "finger.radius");
  };
  EXPECT_EQ(drawn(""), (Words{"10.2552560568 mm", "10.5877245283 mm", "10.9778395118 mm",
                              "10.1176880328 mm"}));
  EXPECT_EQ(drawn("seed = 1\n"), drawn(""));
  EXPECT_NE(drawn("seed = 2\n"), drawn(""));
}

// A, B, then A with one column of B after the other (Saltelli et al. 2010, table 2).
TEST(Saltelli, ExchangesOneColumnAtATime) {
  const Family family =
      of("design = \"saltelli\"\nsamples = 5\n\"finger.radius\" = { from = \"8 mm\", to = \"9 mm\" "
         "}\n\"contact.friction\" = { from = 0.0, to = 1.0 }\n\"tissue.young_modulus\" = { from = "
         "\"1 kPa\", to = \"2 kPa\" }\n");
  ASSERT_EQ(family.cases.size(), 5U * (3 + 2));
  ASSERT_EQ(family.design.count(), family.cases.size());
  const std::vector<double> points = sobol_points(5, 6);
  const std::vector<std::vector<double>> columns{numbers(family, "finger.radius"),
                                                 numbers(family, "contact.friction"),
                                                 numbers(family, "tissue.young_modulus")};
  const double lows[] = {8, 0, 1};
  for (std::size_t sample = 0; sample < 5; ++sample)
    for (std::size_t part = 0; part < 5; ++part)
      for (std::size_t factor = 0; factor < 3; ++factor) {
        const bool from_b = part == 1 || part == factor + 2;
        EXPECT_NEAR(columns[factor][sample * 5 + part],
                    lows[factor] + points[sample * 6 + factor + (from_b ? 3 : 0)],
                    1e-11);  // 12 digits
      }
}

// --- the family of many cases

TEST(Outline, ChecksAMillionCasesWithoutMakingThem) {
  const Family family = outline_text(
      small_press +
          "[sweep]\n\"finger.radius\" = { from = \"8 mm\", to = \"11 mm\", points = 1000 }\n"
          "\"tissue.young_modulus\" = { from = \"1 kPa\", to = \"100 kPa\", points = 1000, "
          "scale = \"log\" }\n",
      "press.toml", {});
  EXPECT_EQ(family.design.count(), 1000000U);
  EXPECT_TRUE(family.cases.empty());
  const Case last = make_case(family, 999999);
  EXPECT_EQ(last.name, "1000000");
  EXPECT_EQ(last.scenario.finger.radius, 0.011);
  EXPECT_EQ(last.scenario.tissue.young_modulus, 1e5);
  EXPECT_EQ(make_case(family, 0).name, "0000001");
  EXPECT_EQ(make_case(family, 1000).swept[0].second, make_case(family, 1999).swept[0].second);
}

TEST(Outline, MakesTheCasesThatReadingMakes) {
  for (const std::string sweep :
       {"",
        "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n\"solver.model\" = [\"hertz\", "
        "\"mass_spring\"]\n",
        "[sweep]\ndesign = \"saltelli\"\nsamples = 3\n\"finger.radius\" = { from = \"8 mm\", to = "
        "\"9 mm\" }\n\"finger.material\" = [\"finger\", \"rigid\"]\n"}) {
    const Family made = parse(small_press + sweep, "press.toml", {});
    const Family planned = outline_text(small_press + sweep, "press.toml", {});
    ASSERT_EQ(planned.design.count(), made.cases.size());
    EXPECT_EQ(planned.title, made.title);
    for (std::size_t i = 0; i < made.cases.size(); ++i) {
      const Case one = make_case(planned, i);
      EXPECT_EQ(one.name, made.cases[i].name);
      EXPECT_EQ(one.swept, made.cases[i].swept);
      EXPECT_EQ(spelled_out(one), spelled_out(made.cases[i]));
    }
  }
}

TEST(Outline, MakesCasesOnSeveralThreads) {
  const Family family = outline_text(
      small_press +
          "[sweep]\ndesign = \"lhs\"\nsamples = 200\n\"finger.radius\" = { from = \"8 mm\", to "
          "= \"9 mm\" }\n\"tissue.material\" = [\"skin\", \"bone\", \"muscle\"]\n",
      "press.toml", {});
  std::vector<std::string> alone;
  for (std::size_t i = 0; i < 200; ++i) alone.push_back(spelled_out(make_case(family, i)));
  std::vector<std::vector<std::string>> made(4);
  {
    std::vector<std::jthread> threads;
    for (std::vector<std::string>& all : made)
      threads.emplace_back([&family, &all] {
        for (std::size_t i = 0; i < 200; ++i) all.push_back(spelled_out(make_case(family, i)));
      });
  }
  for (const std::vector<std::string>& all : made) EXPECT_EQ(all, alone);
}

// Values that fail only together come up when their case is made.
TEST(Outline, LeavesWhatFailsTogetherToTheCase) {
  Family family = outline_text(small_press + "[sweep]\n\"finger.radius\" = [\"1 mm\", \"9 mm\"]\n",
                               "press.toml", {});
  const auto [key, value] = parse_assignment("step.1.to=5 mm");
  set_value(family.document, key, value, value.place);
  EXPECT_EQ(make_case(family, 1).scenario.finger.radius, 0.009);
  EXPECT_THROW((void)make_case(family, 0), InputError);
}

TEST(Outline, OfOneCaseIsThatCase) {
  const std::string sweep =
      "[sweep]\ndesign = \"lhs\"\nsamples = 4\n\"finger.radius\" = { from = \"8 mm\", to = \"9 "
      "mm\" "
      "}\n";
  const Family all = parse(small_press + sweep, "press.toml", {});
  const Family one = parse_case(small_press + sweep, "press.toml", {}, 2);
  ASSERT_EQ(one.cases.size(), 1U);
  EXPECT_EQ(spelled_out(one.cases[0]), spelled_out(all.cases[2]));
  EXPECT_EQ(one.cases[0].swept, all.cases[2].swept);
}

TEST(Notes, SayOnceWhereAKeyIsHonouredInPart) {
  const Family springs = of(
      "\"tissue.poisson_ratio\" = [0.3, 0.4]\n\"solver.model\" = [\"mass_spring\", \"hertz\"]\n");
  ASSERT_EQ(springs.notes.size(), 1U);
  EXPECT_EQ(springs.notes[0].text(),
            "press.toml:5:1: `tissue.poisson_ratio` reaches the contact only: independent springs "
            "have a ratio of their own (findings.csv)");
  EXPECT_TRUE(
      of("\"tissue.poisson_ratio\" = [0.3, 0.4]\n\"solver.model\" = [\"hertz\"]\n").notes.empty());
}

}  // namespace
}  // namespace palpate::scenario
