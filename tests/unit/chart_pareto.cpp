// The front of a cloud and its knee, degenerate clouds too.
#include "chart/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::chart {
namespace {

using Indices = std::vector<std::size_t>;
using Cloud = std::vector<Tradeoff>;

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Pareto, NothingIsOnNoFront) {
  EXPECT_EQ(pareto_front(Cloud{}), Indices{});
  EXPECT_EQ(knee(Cloud{}), std::nullopt);
}

TEST(Pareto, WhatAnotherBeatsIsLeftOut) {
  //           0       1        2       3       4
  const Cloud cloud{{10, 1}, {1, 10}, {5, 5}, {6, 5}, {20, 2}};
  EXPECT_EQ(pareto_front(cloud), (Indices{1, 2, 0}));
}

TEST(Pareto, OneBeatsAll) {
  EXPECT_EQ(pareto_front(Cloud{{3, 3}, {1, 1}, {2, 2}}), Indices{1});
  EXPECT_EQ(pareto_front(Cloud{{3, 3}}), Indices{0});
}

TEST(Pareto, OfEqualOnesTheFirst) {
  EXPECT_EQ(pareto_front(Cloud{{2, 1}, {1, 2}, {2, 1}, {1, 2}}), (Indices{1, 0}));
  // As cheap but righter, as right but cheaper.
  EXPECT_EQ(pareto_front(Cloud{{1, 3}, {1, 2}}), Indices{1});
  EXPECT_EQ(pareto_front(Cloud{{3, 1}, {2, 1}}), Indices{1});
}

TEST(Pareto, WhatIsNoTradeoffTakesNoPart) {
  EXPECT_EQ(
      pareto_front(Cloud{{0, 1}, {1, 0}, {-1, 1}, {infinite, 1e-9}, {NAN, 1}, {1, NAN}, {2, 2}}),
      Indices{6});
}

TEST(Pareto, NobodyOnTheFrontIsBeaten) {
  Cloud cloud;
  unsigned seed = 1;
  const auto next = [&] { return 1.0 + (seed = seed * 1664525U + 1013904223U) % 1000U; };
  for (int i = 0; i < 300; ++i) {
    const double cost = next();
    cloud.push_back({cost, next()});
  }
  const Indices front = pareto_front(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    bool beaten = false;
    for (const Tradeoff& other : cloud)
      beaten = beaten || (other.cost <= cloud[i].cost && other.error <= cloud[i].error &&
                          (other.cost < cloud[i].cost || other.error < cloud[i].error));
    const bool on_it = std::find(front.begin(), front.end(), i) != front.end();
    EXPECT_TRUE(!on_it || !beaten) << i;
    if (!beaten && !on_it) {  // only where the same choice stands there already
      EXPECT_TRUE(std::any_of(front.begin(), front.end(), [&](std::size_t k) {
        return k < i && cloud[k].cost == cloud[i].cost && cloud[k].error == cloud[i].error;
      })) << i;
    }
  }
}

TEST(Knee, FarthestBelowTheChord) {
  // In decades: (0, 4), (1, 1), (2, 0.5), (4, 0): below the chord x + y = 4 by 0, 2, 1.5, 0.
  const Cloud front{{1, 1e4}, {10, 10}, {100, std::sqrt(10.0)}, {1e4, 1}};
  EXPECT_EQ(knee(front), 1U);
}

TEST(Knee, UnitsDoNotMatter) {
  Cloud front{{1, 1e4}, {10, 100}, {100, std::sqrt(10.0)}, {1e4, 1}};
  ASSERT_EQ(knee(front), 2U);
  for (Tradeoff& one : front) one = {1e-3 * one.cost, 100.0 * one.error};
  EXPECT_EQ(knee(front), 2U);
}

TEST(Knee, LogarithmsMatter) {
  // A straight line in the plain numbers bulges above its chord in logarithms.
  EXPECT_EQ(knee(Cloud{{1, 3}, {2, 2}, {3, 1}}), std::nullopt);
}

TEST(Knee, NoneOnAChordAboveItOrOfTwo) {
  EXPECT_EQ(knee(Cloud{{1, 100}, {10, 10}, {100, 1}}), std::nullopt);
  EXPECT_EQ(knee(Cloud{{1, 100}, {10, 90}, {100, 1}}), std::nullopt);
  EXPECT_EQ(knee(Cloud{{1, 100}, {100, 1}}), std::nullopt);
  EXPECT_EQ(knee(Cloud{{1, 100}}), std::nullopt);
}

}  // namespace
}  // namespace palpate::chart
