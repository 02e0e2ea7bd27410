// Comparison in a tube: times may be shifted, values may not.
#include "compare/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace palpate::compare {
namespace {

using record::Table;

Tolerances tube(double width, double abs = 1e-9) {
  Tolerances tolerances;
  tolerances.standard = {.rel = 0.0, .abs = abs};
  tolerances.tube = {"time_s", width};
  return tolerances;
}

// A ramp of 2 N/s that begins at `shift` and lasts 0.5 s, a row every `interval`, for 1 s.
Table ramp(double shift, double interval) {
  Table table{{"case", "time_s", "force_N"}, {}};
  const int rows = static_cast<int>(std::lround(1.0 / interval));
  for (int i = 0; i <= rows; ++i) {
    const double time = i * interval;
    table.rows.push_back({std::string("one"), time, 2.0 * std::clamp(time - shift, 0.0, 0.5)});
  }
  return table;
}

TEST(Tube, TakesAShiftUpToItsWidthAndNoMore) {
  const Table want = ramp(0.2, 0.01);
  EXPECT_TRUE(compare(ramp(0.25, 0.02), want, tube(0.051)).equal());
  const Comparison beyond = compare(ramp(0.25, 0.02), want, tube(0.049));
  EXPECT_FALSE(beyond.equal());
  EXPECT_TRUE(compare(ramp(0.15, 0.02), want, tube(0.051)).equal()) << "early as well as late";
  EXPECT_FALSE(compare(ramp(0.15, 0.02), want, tube(0.049)).equal());
  // 1 ms of 2 N/s beyond the tube: its nearest value is 2 mN away.
  const auto& force = beyond.columns.at(2);
  EXPECT_EQ(force.name, "force_N");
  ASSERT_TRUE(force.worst);
  EXPECT_NEAR(std::get<double>(force.worst->want) - std::get<double>(force.worst->got), 2e-3,
              1e-12);
  // ... which a tolerance of the value may take
  EXPECT_TRUE(compare(ramp(0.25, 0.02), want, tube(0.049, 2.1e-3)).equal());
}

// Between two rows of WANT the straight line counts, however far apart they are.
TEST(Tube, GoesAlongStraightLines) {
  EXPECT_TRUE(compare(ramp(0.0, 0.01), ramp(0.0, 0.5), tube(0.0)).equal());
  Table off = ramp(0.0, 0.01);
  off.rows[30][2] = std::get<double>(off.rows[30][2]) + 1e-6;
  EXPECT_FALSE(compare(off, ramp(0.0, 0.5), tube(0.0)).equal());
}

TEST(Tube, WantsBothEnds) {
  Table early = ramp(0.0, 0.01);
  early.rows.resize(90);  // ends at 0.89 s
  const Comparison shorter = compare(early, ramp(0.0, 0.01), tube(0.1));
  EXPECT_FALSE(shorter.equal());
  EXPECT_EQ(shorter.columns.at(1).name, "time_s");
  EXPECT_EQ(shorter.columns.at(1).differing, 1U);
  EXPECT_TRUE(compare(early, ramp(0.0, 0.01), tube(0.12)).equal());
  // What lies beyond WANT's end is no value of it.
  EXPECT_FALSE(compare(ramp(0.0, 0.01), early, tube(0.1)).equal());
}

TEST(Tube, ComparesWordsAndWhatIsNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  Table want{{"time_s", "word", "radius_mm"},
             {{0.0, std::string("a"), infinity}, {1.0, std::string("b"), std::nan("")}}};
  EXPECT_TRUE(compare(want, want, tube(0.1)).equal());
  Table got = want;
  got.rows[0][1] = std::string("b");
  EXPECT_FALSE(compare(got, want, tube(0.1)).equal());
  EXPECT_TRUE(compare(got, want, tube(1.0)).equal()) << "within the tube there is a `b`";
  got = want;
  got.rows[0][2] = -infinity;
  EXPECT_FALSE(compare(got, want, tube(0.1)).equal());
  got.rows[0][2] = 5.0;
  EXPECT_FALSE(compare(got, want, tube(0.1)).equal());
  got.rows[0][2] = record::Cell();
  EXPECT_FALSE(compare(got, want, tube(0.1)).equal());
}

// Each case has its own time.
TEST(Tube, KeepsCasesApart) {
  Table want = ramp(0.0, 0.1);
  for (const auto& row : ramp(0.3, 0.1).rows) {
    want.rows.push_back(row);
    want.rows.back()[0] = std::string("two");
  }
  EXPECT_TRUE(compare(want, want, tube(0.0)).equal());
  Table got = want;
  got.rows[5][0] = std::string("two");
  EXPECT_FALSE(compare(got, want, tube(0.0)).equal());
  got = want;
  for (auto& row : got.rows)
    if (row[0] == record::Cell(std::string("two"))) row[0] = std::string("three");
  EXPECT_FALSE(compare(got, want, tube(0.0)).equal()) << "a case is missing";
}

TEST(Tube, StandsInTheTolerances) {
  const Tolerances read =
      parse_tolerances("[tube]\nx = \"time_s\"\nwidth = 0.05\n[default]\nabs = 0.1\n", "t.toml");
  ASSERT_TRUE(read.tube);
  EXPECT_EQ(read.tube->x, "time_s");
  EXPECT_EQ(read.tube->width, 0.05);
  EXPECT_EQ(read.standard.abs, 0.1);
  EXPECT_FALSE(parse_tolerances("[default]\nabs = 0.1\n", "t.toml").tube);
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      (void)parse_tolerances(text, "t.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("[tube]\nx = \"time_s\"\n"),
            "t.toml:1:2: `tube` wants `width`; write `width = 0.05`");
  EXPECT_EQ(refusal("[tube]\nwidth = 0.1\n"),
            "t.toml:1:2: `tube` wants `x`; write `x = \"time_s\"`");
  EXPECT_EQ(refusal("[tube]\nx = \"time_s\"\nwidth = -1\n"),
            "t.toml:3:9: `width` must be at least 0, got `-1`; give a value in that range");
  EXPECT_EQ(refusal("[tube]\nx = \"time_s\"\nwide = 1\nwidth = 1\n"),
            "t.toml:3:1: `wide` is not a key here; did you mean `width`?");
}

}  // namespace
}  // namespace palpate::compare
