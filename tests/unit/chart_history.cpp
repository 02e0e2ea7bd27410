// How far a run is from its reference: interpolation, measures, steps.
#include "chart/history.h"

#include <gtest/gtest.h>

#include "scenario_text.h"

namespace palpate::chart {
namespace {

const scenario::Scenario press =
    scenario::read_one(scenario::press + "[[step]]\nkind = \"hold\"\ntime = \"1 s\"\n");
const scenario::Scenario uniform = scenario::read_one(
    scenario::creep + "[[step]]\nkind = \"relax\"\nstrain = 0.1\ntime = \"1 s\"\n");

TEST(ChartHistory, StraightLinesBetweenRows) {
  const History got{{1, 0.0, 0.0}, {1, 1.0, 2.0}, {1, 2.0, 4.0}};
  const History reference{{1, 0.5, 1.0}, {1, 1.25, 2.0}, {1, 2.0, 5.0}};
  const auto off = deviation(press, got, reference);
  ASSERT_TRUE(off);
  // Differences 0, 0.5 and -1 over the greatest, 5.
  EXPECT_DOUBLE_EQ(off->greatest, 0.2);
  EXPECT_DOUBLE_EQ(off->at_end, 0.2);
  EXPECT_DOUBLE_EQ(off->rms, std::sqrt((0.01 + 0.04) / 3.0));
}

TEST(ChartHistory, TheEndIsNotTheGreatest) {
  const History reference{{1, 1.0, 10.0}, {2, 2.0, 8.0}};
  const auto off = deviation(press, {{1, 1.0, 7.0}, {2, 2.0, 7.0}}, reference);
  ASSERT_TRUE(off);
  EXPECT_DOUBLE_EQ(off->greatest, 0.3);
  EXPECT_DOUBLE_EQ(off->at_end, 0.1);
}

TEST(ChartHistory, AStepOfAPressBeginsWhereTheLastOneEnded) {
  // Rows of the second step begin after an interval of it.
  const History got{{1, 0.0, 0.0}, {1, 1.0, 4.0}, {2, 2.0, 2.0}};
  const auto off = deviation(press, got, {{2, 1.5, 3.0}});
  ASSERT_TRUE(off);
  EXPECT_DOUBLE_EQ(off->greatest, 0.0);
}

TEST(ChartHistory, NoLineLeadsFromOneUniformTestToTheNext) {
  const History got{{1, 1.0, 4.0}, {2, 1.0, 6.0}, {2, 2.0, 2.0}};
  const auto off = deviation(uniform, got, {{1, 1.0, 4.0}, {2, 1.5, 4.0}});
  ASSERT_TRUE(off);
  EXPECT_DOUBLE_EQ(off->greatest, 0.0);
}

TEST(ChartHistory, EveryKindOfStepHasItsOwnScale) {
  // Strains of a hundredth beside stresses of a thousand.
  const History reference{{1, 1.0, 0.01}, {2, 2.0, 1000.0}};
  const auto off = deviation(uniform, {{1, 1.0, 0.011}, {2, 2.0, 1000.0}}, reference);
  ASSERT_TRUE(off);
  EXPECT_NEAR(off->greatest, 0.1, 1e-12);  // rounding of 0.011
}

TEST(ChartHistory, NothingWhereTheRunEndsEarly) {
  const History reference{{1, 1.0, 1.0}, {1, 2.0, 2.0}};
  EXPECT_FALSE(deviation(press, {{1, 0.0, 0.0}, {1, 1.5, 1.0}}, reference));
  EXPECT_FALSE(deviation(press, {}, reference));
  EXPECT_FALSE(deviation(press, {{1, 0.0, 0.0}, {1, 2.0, 1.0}}, {}));
  EXPECT_FALSE(deviation(press, {{1, 0.0, 0.0}, {1, 2.0, 1.0}}, {{1, 2.0, 0.0}}))
      << "there is no scale";
}

TEST(ChartHistory, TheReferencesOwnErrorIsMeasuredLikewise) {
  const Deviation own = own_error(press, {{1, 1.0, 5.0, 0.5}, {1, 2.0, 10.0, 0.2}});
  EXPECT_DOUBLE_EQ(own.greatest, 0.05);
  EXPECT_DOUBLE_EQ(own.at_end, 0.02);
}

TEST(ChartHistory, JumpsAreLeftOutOfUniformTests) {
  // Creep loads for 1 s and recovers for 1 s: the second step begins at 2 s.
  EXPECT_DOUBLE_EQ(start_of(uniform, 2), 2.0);
  const History all{{1, 0.0, 1.0}, {1, 0.5, 1.0}, {2, 2.0, 1.0}, {2, 2.5, 1.0}};
  const History kept = without_starts(uniform, all);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].time, 0.5);
  EXPECT_EQ(kept[1].time, 2.5);
  EXPECT_EQ(without_starts(press, all).size(), 4U);
}

TEST(ChartHistory, CreepIsStrainAndRelaxationStress) {
  record::CaseRecord record;
  record.strain = {{1, 0.5, 10.0, 0.25}, {2, 2.5, 20.0, 0.5}};
  const History all = history(uniform, record);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].value, 0.25);
  EXPECT_EQ(all[1].value, 20.0);
}

}  // namespace
}  // namespace palpate::chart
