// Curvature: what is flat, signs and directions, creases and boundaries, refusals, interpolation.
#include "geometry/curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/cuboid.h"
#include "test_surfaces.h"

namespace palpate::geometry {
namespace {

using test::Grid;
using test::Known;

constexpr double infinity = std::numeric_limits<double>::infinity();

CurvatureStars stars(const Surface& surface, const CurvatureOptions& options = {}) {
  return CurvatureStars(surface, Neighbours(surface), options);
}

// kappa_1 t_1 t_1^T + kappa_2 t_2 t_2^T, 1/m.                         docs/theory.md [curvature]
Eigen::Matrix3d shape_tensor(const Curvature& curvature) {
  const auto& [kappa_1, kappa_2, t_1, t_2, normal] = curvature;
  return kappa_1 * t_1 * t_1.transpose() + kappa_2 * t_2 * t_2.transpose();
}

int count(const Surface& surface) { return static_cast<int>(surface.vertices.size()); }

// One turn that leaves no axis in its place.
Vec3 turned(const Vec3& x) {
  const Vec3 axis = Vec3(1.0, 2.0, -0.5).normalized();
  return Eigen::AngleAxisd(0.7, axis) * x;
}

Surface flat(std::uint64_t seed) {
  return test::split_quads({.cells = {9, 7}, .wraps = {false, false}, .seed = seed},
                           [](double u, double v) -> Vec3 {
                             return turned({0.09 * u, 0.07 * v, 0.0}) + Vec3(0.3, -0.2, 0.1);
                           });
}

class EveryMethod : public testing::TestWithParam<CurvatureMethod> {};

TEST_P(EveryMethod, FlatIsFlat) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Surface surface = flat(seed);
    const CurvatureStars at = stars(surface, {.method = GetParam()});
    int full = 0;
    for (int v = 0; v < count(surface); ++v) {
      const CurvatureEstimate found = at.at_vertex(surface, v);
      ASSERT_TRUE(found.known()) << v << ": " << explanation(found.status);
      full += found.status == StarStatus::full ? 1 : 0;
      const double bound = 1e-12 / 0.01;  // edges are 10 mm
      EXPECT_LE(std::abs(found.curvature.kappa_1), bound);
      EXPECT_LE(std::abs(found.curvature.kappa_2), bound);
      EXPECT_NEAR(found.curvature.normal.dot(turned(Vec3::UnitZ())), 1.0, 1e-14);  // rounding
    }
    EXPECT_EQ(full, 6 * 4);  // two rows at every rim are one-sided
  }
}

// Outwards is convex; the same surface inside out has the signs and the order turned round.
TEST_P(EveryMethod, SignAndOrder) {
  Known tube = test::cylinder(0.125, 1.0, {.jitter = 0.0, .random_diagonals = false});
  const int middle = count(tube.surface) / 2;
  const CurvatureOptions options{.method = GetParam()};
  const Curvature outside = stars(tube.surface, options).at_vertex(tube.surface, middle).curvature;
  for (auto& triangle : tube.surface.triangles) std::swap(triangle[0], triangle[1]);
  const Curvature inside = stars(tube.surface, options).at_vertex(tube.surface, middle).curvature;
  EXPECT_GT(outside.kappa_1, 0.5);
  EXPECT_LT(inside.kappa_2, -0.5);
  EXPECT_NEAR(inside.kappa_1, -outside.kappa_2, 1e-12);  // rounding of curvatures near 1
  EXPECT_NEAR(inside.kappa_2, -outside.kappa_1, 1e-12);  // as above
  EXPECT_LT(inside.normal.dot(outside.normal), -0.999);
}

TEST_P(EveryMethod, MovesWithTheSurface) {
  const Known body = test::torus(0.5, 2.0);
  Surface moved = body.surface;
  for (Vec3& x : moved.vertices) x = turned(1e-3 * x) + Vec3(0.2, 0.1, -0.3);
  const CurvatureStars at = stars(body.surface, {.method = GetParam()});
  for (int v = 0; v < count(moved); ++v) {
    const Curvature before = at.at_vertex(body.surface, v).curvature;
    const Curvature after = at.at_vertex(moved, v).curvature;
    EXPECT_NEAR(1e-3 * after.kappa_1, before.kappa_1, 1e-10);  // rounding at 0.3 m from the origin
    EXPECT_NEAR(1e-3 * after.kappa_2, before.kappa_2, 1e-10);  // as above
    EXPECT_LT((after.normal - turned(before.normal)).norm(), 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values(CurvatureMethod::quadric, CurvatureMethod::taubin));

TEST(Curvature, DirectionsOfACylinder) {
  const Known tube = test::cylinder(0.125);
  const CurvatureStars at = stars(tube.surface);
  int asked = 0;
  for (int v = 0; v < count(tube.surface); ++v) {
    const CurvatureEstimate found = at.at_vertex(tube.surface, v);
    if (found.status != StarStatus::full) continue;
    ++asked;
    const auto& [kappa_1, kappa_2, t_1, t_2, normal] = found.curvature;
    EXPECT_GT(std::abs(t_2.z()), 1.0 - 1e-4);            // within 0.8 degrees of the axis
    EXPECT_LT((t_1.cross(t_2) - normal).norm(), 1e-13);  // rounding
    const Eigen::Matrix3d tensor = shape_tensor(found.curvature);
    EXPECT_LT((tensor * t_1 - kappa_1 * t_1).norm(), 1e-13);  // rounding
    EXPECT_LT((tensor * normal).norm(), 1e-13);               // rounding
  }
  EXPECT_GT(asked, 1000);
}

TEST(Curvature, PrincipalValuesOfAMatrix) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(1, 1, 1).normalized()})
    for (const auto& m : {std::array{2.0, 0.0, 1.0}, std::array{1.0, 0.0, 2.0},
                          std::array{-3.0, 0.5, -3.0}, std::array{1.0, -1e-9, 1.0 + 1e-9},
                          std::array{5.0, 0.0, 5.0}, std::array{0.0, 0.0, 0.0}}) {
      const auto [x, y] = tangent_axes(normal);
      const Eigen::Matrix3d want = m[0] * x * x.transpose() + m[2] * y * y.transpose() +
                                   m[1] * (x * y.transpose() + y * x.transpose());
      const Curvature got = principal(normal, m);
      EXPECT_GE(got.kappa_1, got.kappa_2);
      EXPECT_LT((shape_tensor(got) - want).norm(), 1e-14);  // rounding of numbers up to 5
      EXPECT_NEAR(got.direction_1.norm(), 1.0, 1e-15);      // rounding
      EXPECT_LT((got.direction_1.cross(got.direction_2) - normal).norm(), 1e-15);
    }
}

// A box is flat on every side of every edge, and an edge belongs to no side by itself.
TEST(Curvature, StopsAtCreases) {
  const Surface box =
      outer_surface(cuboid({0.04, 0.05, 0.03}, {4, 5, 3}, CellPattern::mirrored)).surface;
  const CurvatureStars at = stars(box);
  int creased = 0;
  for (std::size_t t = 0; t < box.triangles.size(); ++t)
    for (const int v : box.triangles[t]) {
      const CurvatureEstimate found = at.at_vertex(box, v, static_cast<int>(t));
      ASSERT_TRUE(found.known()) << v << ": " << explanation(found.status);
      EXPECT_LE(std::abs(found.curvature.kappa_1), 1e-10);  // 1e-12 of 1/edge
      EXPECT_LE(std::abs(found.curvature.kappa_2), 1e-10);  // as above
      const Vec3 face = twice_area(box, static_cast<int>(t)).normalized();
      EXPECT_NEAR(found.curvature.normal.dot(face), 1.0, 1e-14);  // rounding
      if (at.at_vertex(box, v).status == StarStatus::on_crease) {
        ++creased;
        EXPECT_EQ(found.status, StarStatus::one_sided);
      }
    }
  EXPECT_GT(creased, 100);
}

// Two planes at an angle, 20 triangles each: below the limit they are one round surface.
CurvatureEstimate on_a_fold(double degrees, double limit) {
  const double slope = std::tan(degrees * std::numbers::pi / 360.0);
  const Surface fold = test::split_quads({.cells = {6, 6}, .wraps = {false, false}, .jitter = 0.0},
                                         [&](double u, double v) -> Vec3 {
                                           return {u, v, -slope * std::abs(u - 0.5)};
                                         });
  return stars(fold, {.crease_angle = limit * std::numbers::pi / 180.0}).at_vertex(fold, 24);
}

TEST(Curvature, ACreaseIsWhatIsSharperThanTheLimit) {
  EXPECT_EQ(on_a_fold(39.0, 40.0).status, StarStatus::full);
  EXPECT_GT(on_a_fold(39.0, 40.0).curvature.kappa_1, 0.5);
  EXPECT_EQ(on_a_fold(41.0, 40.0).status, StarStatus::on_crease);
  EXPECT_EQ(on_a_fold(41.0, 60.0).status, StarStatus::full);
}

// The rim of a closed tube is round on one side and flat on the other.
TEST(Curvature, TwoSidesOfARim) {
  Known tube = test::cylinder(0.125, 1.0, {.jitter = 0.0});
  Surface& surface = tube.surface;
  const int around = 50;  // 2 pi / 0.125
  const int rim_triangle = static_cast<int>(surface.triangles.size());
  // A floor of two rings, so that its side of the rim has neighbours enough.
  const int inner = count(surface);
  for (int i = 0; i < around; ++i)
    surface.vertices.push_back(0.5 * surface.vertices[static_cast<std::size_t>(i)]);
  surface.vertices.emplace_back(0.0, 0.0, 0.0);
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    surface.triangles.push_back({next, i, inner + i});
    surface.triangles.push_back({next, inner + i, inner + next});
    surface.triangles.push_back({inner + next, inner + i, inner + around});
  }
  const CurvatureStars at = stars(surface);
  EXPECT_EQ(at.at_vertex(surface, 0).status, StarStatus::on_crease);
  const CurvatureEstimate floor = at.at_vertex(surface, 0, rim_triangle);
  ASSERT_EQ(floor.status, StarStatus::one_sided);
  EXPECT_NEAR(floor.curvature.kappa_1, 0.0, 1e-11);  // rounding
  EXPECT_NEAR(floor.curvature.normal.z(), -1.0, 1e-14);
  const CurvatureEstimate wall = at.at_vertex(surface, 0, 0);
  ASSERT_EQ(wall.status, StarStatus::one_sided);
  EXPECT_NEAR(wall.curvature.kappa_1, 1.0, 0.01);  // the figure, here met by one side too
  EXPECT_NEAR(wall.curvature.kappa_2, 0.0, 0.01);  // as above
  // The middle of a rim triangle mixes sides of one kind only.
  const CurvatureEstimate point = between(at.at_corners(surface, rim_triangle), {0.2, 0.3, 0.5});
  ASSERT_EQ(point.status, StarStatus::one_sided);
  EXPECT_NEAR(point.curvature.kappa_1, 0.0, 1e-11);  // rounding
}

// Sides are settled at rest: a flat sheet that is rolled up has the curvature of the roll.
TEST(Curvature, FollowsADeformedSurface) {
  const auto sheet = [](double kappa) {
    return test::split_quads(
        {.cells = {16, 16}, .wraps = {false, false}}, [&](double u, double v) -> Vec3 {
          const double angle = kappa * (u - 0.5);
          return {std::sin(angle) / kappa, v - 0.5, (std::cos(angle) - 1.0) / kappa};
        });
  };
  const Surface rest = sheet(1e-9);
  const CurvatureStars at = stars(rest);
  for (const double kappa : {-2.0, -1.0, 0.5, 2.0}) {
    const Surface rolled = sheet(kappa);
    for (int v = 0; v < count(rest); ++v) {
      const CurvatureEstimate found = at.at_vertex(rolled, v);
      if (found.status != StarStatus::full) continue;
      const double larger = kappa > 0.0 ? found.curvature.kappa_1 : found.curvature.kappa_2;
      EXPECT_NEAR(larger, kappa, 0.01 * std::abs(kappa));  // edges of up to 1/8 of the radius
    }
  }
}

// The sides of a block of twelve triangles, whose corners have two or three neighbours.
TEST(Curvature, OfAPlaneNeedsNoNeighbours) {
  const Surface block = box_surface({0.06, 0.05, 0.03}, {1, 1, 1});
  for (int t = 0; t < 12; ++t) {
    const CurvatureEstimate found = between(stars(block).at_corners(block, t), {0.2, 0.3, 0.5});
    EXPECT_EQ(found.status, StarStatus::full);
    EXPECT_EQ(found.curvature.kappa_1, 0.0);
    EXPECT_EQ(found.curvature.kappa_2, 0.0);
    EXPECT_NEAR(found.curvature.normal.dot(twice_area(block, t).normalized()), 1.0, 1e-12);
  }
}

TEST(Curvature, RefusesWithAReason) {
  const Surface two{{{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0}, {5, 5, 5}},
                    {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(stars(two).at_vertex(two, 0).status, StarStatus::too_few);
  EXPECT_EQ(stars(two).at_vertex(two, 4).status, StarStatus::too_few) << "no triangle at all";
  EXPECT_EQ(between(stars(two).at_corners(two, 0), {1.0, 0.0, 0.0}).status, StarStatus::too_few);

  // A band one cell wide: its two lines of vertices cannot tell how it bends across.
  const Surface band = test::split_quads({.cells = {9, 1}, .wraps = {false, false}, .jitter = 0.0},
                                         [](double u, double v) -> Vec3 {
                                           return {9.0 * u, v, u * u};
                                         });
  EXPECT_EQ(stars(band, {.rings = 3}).at_vertex(band, 5).status, StarStatus::degenerate);

  for (const double bad : {std::nan(""), infinity})
    for (const auto method : {CurvatureMethod::quadric, CurvatureMethod::taubin}) {
      const Surface good = flat(1);
      Surface broken = good;
      broken.vertices[33].x() = bad;
      EXPECT_EQ(stars(good, {.method = method}).at_vertex(broken, 34).status,
                StarStatus::degenerate);
    }
  // A neighbour that has come to lie upon the vertex.
  for (const auto method : {CurvatureMethod::quadric, CurvatureMethod::taubin}) {
    Surface folded = flat(1);
    const CurvatureStars before = stars(folded, {.method = method});
    folded.vertices[34] = folded.vertices[33];
    EXPECT_EQ(before.at_vertex(folded, 33).status, StarStatus::degenerate);
  }
  Surface lump = flat(1);
  const CurvatureStars at = stars(lump);
  for (Vec3& x : lump.vertices) x = Vec3(1, 2, 3);
  EXPECT_EQ(at.at_vertex(lump, 33).status, StarStatus::degenerate);
}

TEST(Curvature, IsOneValueOnEveryEdgeFromBothItsTriangles) {
  const Known body = test::torus(0.4, 2.0);
  const Neighbours neighbours(body.surface);
  const CurvatureStars at(body.surface, neighbours);
  for (std::size_t t = 0; t < body.surface.triangles.size(); ++t) {
    const int other = neighbours.across(static_cast<int>(t))[0];
    const auto& mine = body.surface.triangles[t];
    const auto& theirs = body.surface.triangles[static_cast<std::size_t>(other)];
    std::array<double, 3> weights{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (theirs[i] == mine[0]) weights[i] = 0.3;
      if (theirs[i] == mine[1]) weights[i] = 0.7;
    }
    const auto here = between(at.at_corners(body.surface, static_cast<int>(t)), {0.3, 0.7, 0.0});
    const auto there = between(at.at_corners(body.surface, other), weights);
    EXPECT_LT((shape_tensor(here.curvature) - shape_tensor(there.curvature)).norm(),
              1e-13);  // rounding of curvatures near 1
  }
}

TEST(Curvature, BetweenVerticesOfASphereIsTheSphere) {
  const std::array<Vec3, 3> places{Vec3(1, 0, 0.1).normalized(), Vec3(1, 0.5, 0).normalized(),
                                   Vec3(1, 0.2, 0.4).normalized()};
  std::array<Curvature, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = principal(places[i], {2.0, 0.0, 2.0});
  const Curvature inside = between(corners, {0.2, 0.3, 0.5});
  EXPECT_NEAR(inside.kappa_1, 2.0, 1e-14);  // rounding
  EXPECT_NEAR(inside.kappa_2, 2.0, 1e-14);  // as above
  const Vec3 mean = 0.2 * places[0] + 0.3 * places[1] + 0.5 * places[2];
  EXPECT_LT((inside.normal - mean.normalized()).norm(), 1e-15);
  // In a corner it is that corner's.
  corners[1] = principal(places[1], {3.0, 0.5, 1.0});
  const Curvature corner = between(corners, {0.0, 1.0, 0.0});
  EXPECT_LT((shape_tensor(corner) - shape_tensor(corners[1])).norm(), 1e-14);  // rounding
}

}  // namespace
}  // namespace palpate::geometry
