// The factor of deep presses against the finite elements that it was fitted to.
#include "contact/depth_ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "record/csv.h"

namespace palpate::contact {
namespace {

constexpr double radius = 0.011;  // m
constexpr double half_space = std::numeric_limits<double>::infinity();

DepthRatio ratio_of(double nu, double thickness, LayerBase base = LayerBase::bonded) {
  const auto found =
      depth_ratio({.radius = radius, .thickness = thickness, .poisson_ratio = nu, .base = base});
  EXPECT_TRUE(found.has_value()) << nu << " " << thickness;
  return found.value_or(DepthRatio{});
}

TEST(DepthRatio, IsThatOfTheFiniteElements) {
  const record::Table table =
      record::read_csv(PALPATE_SOURCE_DIR "/tests/elasticity/deep_layers.csv");
  const auto number = [&](const auto& row, const char* name) {
    return std::get<double>(row[static_cast<std::size_t>(table.find(name))]);
  };
  const auto base_column = static_cast<std::size_t>(table.find("base"));
  std::size_t rows = 0;
  for (const auto& row : table.rows) {
    const double depth = number(row, "depth"), thickness = number(row, "thickness");
    const double deepest = std::min(0.8, 0.6 * thickness);
    // The shallowest contacts are only a few elements wide; the deepest are beyond the formula.
    if (depth < 0.02 * deepest || depth > DepthRatio::deepest_y * thickness) continue;
    const auto base = std::get<std::string>(row[base_column]) == "bonded" ? LayerBase::bonded
                                                                          : LayerBase::frictionless;
    const double computed = number(row, "ratio");
    const auto got =
        ratio_of(number(row, "poisson"), thickness * radius, base).value(depth * radius);
    // The fit's largest error, 0.2 %.
    EXPECT_NEAR(got, computed, 0.0025 * computed) << depth << " " << thickness;
    ++rows;
  }
  EXPECT_GT(rows, 4000U);
}

// Forces of tests/elasticity/axisymmetric.py on a disc of radius 33.851 mm and 30 mm height (the
// area of a block of 60 x 60 mm) under a sphere of 11 mm, in mN: neo-Hookean, and those of linear
// elasticity under a paraboloid. The wide layer's ratio is 3.3 % too low for the last one.
TEST(DepthRatio, StatesWhatSidesChange) {
  struct Row {
    double nu, depth, neo_hookean, paraboloid;
  };
  for (const Row& row : {Row{0.33, 0.005, 5153.64, 5059.83}, Row{0.45, 0.005, 5386.0, 5766.36},
                         Row{0.45, 0.008, 11105.0, 12529.2}, Row{0.49, 0.003, 2495.95, 2671.36},
                         Row{0.49, 0.005, 5497.79, 6112.28}, Row{0.49, 0.008, 11197.3, 13314.7}}) {
    const auto found = depth_ratio(
        {.radius = radius, .thickness = 0.030, .poisson_ratio = row.nu, .half_width = 0.033851});
    ASSERT_TRUE(found);
    const double ratio = row.neo_hookean / row.paraboloid;
    const double left = std::abs(found->value(row.depth) / ratio - 1.0);
    EXPECT_LE(left, found->error(row.depth)) << row.nu << " " << row.depth;
  }
}

// Cases of group `large`: another program on a half-space, 0.3 %, and this formula's 0.2 %.
TEST(DepthRatio, CasesOnAHalfSpace) {
  const auto expect = [](const char* id, double nu, double x, double value) {
    EXPECT_NEAR(ratio_of(nu, half_space).value(x * radius), value, 0.005 * value) << id;
  };
  expect("large-01", 0.27, 0.1, 1.0217802);
  expect("large-03", 0.27, 0.5, 1.0297139);
  expect("large-04", 0.33, 0.1, 1.0114491);
  expect("large-08", 0.40, 0.3, 0.98321556);
  expect("large-12", 0.45, 0.5, 0.93662035);
  expect("large-13", 0.49, 0.1, 0.97304673);
  expect("large-15", 0.49, 0.5, 0.90849821);
  expect("large-16", 0.4995, 0.1, 0.96972309);
  expect("large-18", 0.4995, 0.5, 0.90123217);
}

TEST(DepthRatio, IsEmptyWhereNothingWasComputed) {
  const auto exists = [](double nu, double thickness) {
    return depth_ratio({.radius = radius, .thickness = thickness, .poisson_ratio = nu}).has_value();
  };
  EXPECT_TRUE(exists(0.5, half_space));
  for (const double nu : {-0.01, 0.501, std::nan("")}) EXPECT_FALSE(exists(nu, half_space)) << nu;
  for (const double thickness : {0.29 * radius, 0.0, -1.0, std::nan("")})
    EXPECT_FALSE(exists(0.3, thickness)) << thickness;

  const DepthRatio thick = ratio_of(0.3, half_space);
  EXPECT_DOUBLE_EQ(thick.last_depth(), 0.8 * radius);
  EXPECT_DOUBLE_EQ(ratio_of(0.3, radius).last_depth(), 0.5 * radius);
  for (const double depth : {0.0, -1.0}) {
    EXPECT_EQ(thick.value(depth), 1.0);
    EXPECT_EQ(thick.error(depth), 0.0);
  }
}

// Beyond the depth that is known the factor stays, and its error grows by its distance from 1.
TEST(DepthRatio, StaysBeyondTheLastDepth) {
  const DepthRatio thick = ratio_of(0.49, half_space);
  const double last = thick.last_depth();
  EXPECT_EQ(thick.value(1.5 * last), thick.value(last));
  EXPECT_NEAR(thick.error(1.5 * last), thick.error(last) + 0.5 * std::abs(thick.value(last) - 1.0),
              1e-12);
}

// An elastic finger takes its share of the depth.
TEST(DepthRatio, IsThatOfTheDepthInTheTissue) {
  DeepPress press{.radius = radius, .thickness = half_space, .poisson_ratio = 0.45};
  const DepthRatio rigid = depth_ratio(press).value();
  press.tissue_share = 0.25;
  const DepthRatio soft = depth_ratio(press).value();
  EXPECT_DOUBLE_EQ(soft.value(2e-3), rigid.value(0.5e-3));
  EXPECT_DOUBLE_EQ(soft.last_depth(), 4.0 * rigid.last_depth());
}

// q = 1/2 at nu = 1/3.
TEST(DepthBound, GrowsWithTheDepth) {
  EXPECT_EQ(depth_bound(0.0, 1.0, 1.0, 0.3), 0.0);
  EXPECT_NEAR(depth_bound(0.25e-2, 1e-2, 2.5e-2, 1.0 / 3.0), 0.5 * (0.25 * 0.5 + 0.1), 1e-12);
  EXPECT_NEAR(depth_bound(1e-3, 1e-2, half_space, 0.5), 0.05 * std::sqrt(0.1), 1e-12);
}

// Forces of tests/cases/bodies.csv, which had no part in it: neo-Hookean over a paraboloid in
// linear elasticity (force_low).
TEST(DepthBound, HoldsOnOtherBodies) {
  const record::Table table = record::read_csv(PALPATE_SOURCE_DIR "/tests/cases/bodies.csv");
  const auto text = [&](const auto& row, const char* name) -> const record::Cell& {
    return row[static_cast<std::size_t>(table.find(name))];
  };
  int rows = 0;
  for (const auto& row : table.rows) {
    const auto* neo_hookean = std::get_if<double>(&text(row, "force_neo_hookean_mN"));
    const auto* ratio = std::get_if<double>(&text(row, "poisson_ratio"));
    if (neo_hookean == nullptr || ratio == nullptr ||
        std::get<std::string>(text(row, "group")) != "dome")
      continue;
    const auto number = [&](const char* name) { return std::get<double>(text(row, name)); };
    ++rows;
    const double change = *neo_hookean / number("force_low_mN") - 1.0;
    // The domes are 10 mm high and more.
    EXPECT_LE(std::abs(change), depth_bound(1e-3 * number("travel_mm"),
                                            1e-3 * number("sphere_radius_mm"), 0.010, *ratio))
        << number("travel_mm");
  }
  EXPECT_GT(rows, 0);
}

}  // namespace
}  // namespace palpate::contact
