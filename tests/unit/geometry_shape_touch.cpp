// The touch in closed form against the same shapes as triangles.
#include "geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/box_tree.h"
#include "test_surfaces.h"

namespace palpate::geometry {
namespace {

struct Case {
  const char* name;
  Shape shape;
  double radius;   // m, of the sphere
  double spacing;  // m, of the triangles
  // Places (parts of the size along x and y) where the shape curves evenly over a few triangles.
  std::vector<std::array<double, 2>> places;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class Touches : public testing::TestWithParam<Case> {};

Curvature at_vertex_near(const Surface& surface, const Vec3& point) {
  const Neighbours neighbours(surface);
  const CurvatureStars stars(surface, neighbours);
  const Near near = BoxTree(surface).nearest(point);
  const auto estimate = between(stars.at_corners(surface, near.triangle),
                                {near.weights[0], near.weights[1], near.weights[2]});
  EXPECT_TRUE(estimate.known());
  return estimate.curvature;
}

TEST_P(Touches, IsWhereTheSphereMeetsTheTriangles) {
  const auto& [name, shape, radius, spacing, places] = GetParam();
  const Surface surface = sampled(shape, {spacing, spacing}).parts.front().surface;
  const BoxTree tree(surface);
  const Vec3 size = extent(shape);
  // A triangle's circumscribed circle, of 0.7 of its edge, is nearer than this to the round shape.
  const double chord = 0.5 * spacing * spacing / std::min(size.x(), size.z());
  for (const auto& [part_x, part_y] : places) {
    const double x = part_x * size.x();
    const double y = part_y * size.y();
    const auto touch = touch_from_above(shape, x, y, radius);
    ASSERT_TRUE(touch && !touch->on_edge) << part_x << " " << part_y;
    const Vec3 centre = touch->position + radius * touch->curvature.normal;
    EXPECT_NEAR(centre.x(), x, 1e-9 * size.x());  // rounding of the bisection
    EXPECT_NEAR(centre.y(), y, 1e-9 * size.y());
    const Near near = tree.nearest(centre);
    EXPECT_NEAR(std::sqrt(near.distance_squared), radius, chord + 1e-9);
    // The nearest point of the triangles lies around the touch, within the circle that the chord
    // allows.
    const auto& corners = surface.triangles[as_index(near.triangle)];
    Vec3 nearest = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      nearest +=
          near.weights[static_cast<Eigen::Index>(i)] * surface.vertices[as_index(corners[i])];
    EXPECT_LT((nearest - touch->position).norm(), 1.5 * spacing);
  }
}

TEST_P(Touches, HasTheCurvatureOfTheTriangles) {
  const auto& [name, shape, radius, spacing, places] = GetParam();
  const Surface surface = sampled(shape, {spacing, spacing}).parts.front().surface;
  const Vec3 size = extent(shape);
  for (const auto& [part_x, part_y] : places) {
    const auto touch = touch_from_above(shape, part_x * size.x(), part_y * size.y(), radius);
    ASSERT_TRUE(touch && !touch->on_edge);
    const Curvature fitted = at_vertex_near(surface, touch->position);
    const double most = std::max(std::abs(fitted.kappa_1), std::abs(fitted.kappa_2));
    // A per cent, of the larger one: the fit is that good, the closed form is exact.
    EXPECT_NEAR(touch->curvature.kappa_1, fitted.kappa_1, 0.01 * most) << part_x << " " << part_y;
    EXPECT_NEAR(touch->curvature.kappa_2, fitted.kappa_2, 0.01 * most) << part_x << " " << part_y;
    EXPECT_GT(touch->curvature.normal.dot(fitted.normal), std::cos(0.01));
    const double apart = touch->curvature.kappa_1 - touch->curvature.kappa_2;
    if (apart > 0.2 * most) {
      EXPECT_GT(std::abs(touch->curvature.direction_1.dot(fitted.direction_1)), std::cos(0.05));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Touches,
    testing::Values(
        Case{"cylinder", Cylinder{}, 0.011, 1.5e-3, {{0.5, 0.5}, {0.3, 0.4}, {0.85, 0.6}}},
        Case{"ellipsoid", Ellipsoid{}, 0.011, 4e-3, {{0.5, 0.5}, {0.3, 0.6}, {0.8, 0.75}}},
        Case{"flat_ellipsoid",
             Ellipsoid{{0.10, 0.06, 0.03}},
             0.008,
             1e-3,
             {{0.5, 0.5}, {0.35, 0.6}, {0.7, 0.35}}},
        Case{"bone", BoneShaft{}, 0.011, 1.2e-3, {{0.5, 0.5}, {0.45, 0.8}, {0.6, 0.25}}},
        Case{"limb", LayeredLimb{}, 0.011, 5e-3, {{0.5, 0.5}, {0.3, 0.2}, {0.65, 0.7}}},
        Case{"ligament", Ligament{}, 0.011, 0.3e-3, {{0.5, 0.5}, {0.3, 0.3}, {0.6, 0.8}}}));

// Between the flat top and the side of the strap the section is round: the finger meets it beside.
TEST(Ligaments, AreRoundAtTheirSides) {
  const Ligament strap;
  const Vec3 size = extent(strap);
  // In the middle of the length: straight for 11 mm to each side, then round with 2.5 mm.
  const auto side = touch_from_above(strap, 0.5 * size.x() + 0.017, 0.5 * size.y(), 0.011);
  ASSERT_TRUE(side.has_value());
  const double cosine = 0.006 / (0.0025 + 0.011);
  EXPECT_NEAR(side->curvature.normal.x(), cosine, 1e-9);
  EXPECT_NEAR(side->position.x(), 0.5 * size.x() + 0.011 + 0.0025 * cosine, 1e-9);
  EXPECT_NEAR(side->curvature.kappa_1, 400.0, 1e-6 * 400.0);
  // Along y the half circle is thicker and farther out at the ends: hollow.
  EXPECT_LT(side->curvature.kappa_2, -1.0);
  EXPECT_NEAR(touch_from_above(strap, 0.5 * size.x(), 0.5 * size.y(), 0.011)->curvature.kappa_2,
              -0.5 * 0.005 * 0.2 * 8.0 / (0.044 * 0.044), 1e-5);
}

TEST(ACylinder, IsTouchedOnItsRimBeyondItsEnd) {
  const Cylinder cylinder;
  EXPECT_TRUE(touch_from_above(cylinder, 0.03, -0.005, 0.011)->on_edge);
  EXPECT_TRUE(touch_from_above(cylinder, 0.03, 0.084, 0.011)->on_edge);
  EXPECT_FALSE(touch_from_above(cylinder, 0.03, 0.001, 0.011)->on_edge);
  EXPECT_FALSE(touch_from_above(cylinder, 0.03, -0.012, 0.011).has_value());
  EXPECT_FALSE(touch_from_above(cylinder, 0.072, 0.04, 0.011).has_value());
  EXPECT_TRUE(touch_from_above(cylinder, 0.070, 0.04, 0.011).has_value());
}

// A large ball on a hollow shaft rests on the flared ends before it reaches the middle.
TEST(AShaft, IsTouchedWhereItIsHighest) {
  const BoneShaft hollow{.length = 0.04, .radius = 0.010, .end_radius = 0.020};
  EXPECT_TRUE(touch_from_above(hollow, 0.020, 0.018, 0.5)->on_edge);
  EXPECT_FALSE(touch_from_above(hollow, 0.020, 0.020, 0.005)->on_edge);
}

TEST(AnEllipsoid, IsMissedBesideItsWidestSection) {
  const Ellipsoid ball{{0.1, 0.1, 0.1}};
  EXPECT_TRUE(touch_from_above(ball, 0.1099, 0.05, 0.01).has_value());
  EXPECT_FALSE(touch_from_above(ball, 0.1101, 0.05, 0.01).has_value());
  const auto touch = touch_from_above(ball, 0.08, 0.05, 0.01);
  EXPECT_NEAR(touch->curvature.kappa_1, 20.0, 1e-9);
  EXPECT_NEAR(touch->curvature.kappa_2, 20.0, 1e-9);
  EXPECT_NEAR(touch->curvature.normal.x(), 0.5, 1e-12);
}

TEST(ADisc, IsFlatOnItsRoundTopOnly) {
  const Disc disc{0.010, 0.004};
  const auto touch = touch_from_above(disc, 0.016, 0.017, 0.002);  // 9.2 mm from the axis
  ASSERT_TRUE(touch.has_value());
  EXPECT_FALSE(touch->on_edge);
  EXPECT_EQ(touch->position, Vec3(0.016, 0.017, 0.004));
  EXPECT_EQ(touch->curvature.kappa_1, 0.0);
  EXPECT_TRUE(touch_from_above(disc, 0.018, 0.018, 0.002)->on_edge);      // 11.3 mm, in its square
  EXPECT_FALSE(touch_from_above(disc, 0.019, 0.019, 0.002).has_value());  // 12.7 mm
}

TEST(ACuboid, IsFlatOnItsTopOnly) {
  EXPECT_EQ(touch_from_above(Cuboid{}, 0.01, 0.02, 0.011)->position, Vec3(0.01, 0.02, 0.03));
  EXPECT_TRUE(touch_from_above(Cuboid{}, -0.005, 0.02, 0.011)->on_edge);
  EXPECT_FALSE(touch_from_above(Cuboid{}, -0.012, 0.02, 0.011).has_value());
}

}  // namespace
}  // namespace palpate::geometry
