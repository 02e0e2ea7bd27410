// What a node of the skin is to a sphere: areas, normals of the sides that face it, facets, and the
// half-space's surface displacement under a node's own load.
#include "mechanics/resolved_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/cuboid.h"
#include "geometry/shape_loops.h"

namespace palpate::mechanics {
namespace {

// The skin of a box of cells with sides `cell`; its top is at z = 4 cells.
geometry::SmoothSurface box_surface(double cell, geometry::CellPattern pattern) {
  return geometry::SmoothSurface(
      geometry::outer_surface(geometry::cuboid(Vec3::Constant(4.0 * cell), {4, 4, 4}, pattern))
          .surface);
}

int vertex_at(const geometry::SmoothSurface& outer_surface, const Vec3& place) {
  const auto& all = outer_surface.surface().vertices;
  for (std::size_t v = 0; v < all.size(); ++v)
    if ((all[v] - place).norm() < 1e-9) return static_cast<int>(v);
  ADD_FAILURE() << "no vertex there";
  return 0;
}

TEST(PressedNodes, share_the_top_and_see_only_sides_that_face_the_sphere) {
  const double cell = 1e-3;
  const auto outer_surface = box_surface(cell, geometry::CellPattern::mirrored);
  const SurfaceNodes nodes(outer_surface);
  const Ball ball{Vec3(2e-3, 2e-3, 15e-3), 11e-3};
  double area = 0.0;
  for (int v = 0; v < static_cast<int>(outer_surface.surface().vertices.size()); ++v) {
    const auto node = nodes.facing(v, ball);
    const bool top = outer_surface.surface().vertices[static_cast<std::size_t>(v)].z() > 3.5e-3;
    ASSERT_EQ(node.has_value(), top) << v;
    if (!node) continue;
    EXPECT_EQ(node->normal, Vec3(Vec3::UnitZ()));  // at the rim too: the walls look away
    area += node->area;
  }
  EXPECT_NEAR(area, 16e-6, 1e-18);  // rounding of a sum of 25
}

// In a lattice of squares cut by diagonals the sides of every triangle are c, c and sqrt(2) c:
// 4 c^2 / 12 of |s|^2 in the mean over it, over 2 R.
TEST(PressedNodes, facets_stand_off_a_sphere_by_a_sixth_of_the_square_of_a_cell_over_the_radius) {
  const double cell = 1e-3;
  const double radius = 11e-3;
  for (const auto pattern : {geometry::CellPattern::kuhn, geometry::CellPattern::mirrored}) {
    const auto outer_surface = box_surface(cell, pattern);
    const SurfaceNodes nodes(outer_surface);
    for (int v = 0; v < static_cast<int>(outer_surface.surface().vertices.size()); ++v)
      if (const auto node = nodes.facing(v, {Vec3(2e-3, 2e-3, 15e-3), radius})) {
        EXPECT_NEAR(node->facets, cell * cell / (6.0 * radius), 1e-18);  // rounding
      }
  }
}

// A ball on a ball: what facets cut off the skin counts like the curvature of the sphere.
TEST(PressedNodes, facets_of_a_curved_skin_add_its_own_curvature) {
  const double own = 20e-3;
  const geometry::SmoothSurface outer_surface(
      geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(2.0 * own), 2e-3));
  const SurfaceNodes nodes(outer_surface);
  const double radius = 11e-3;
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int v = 0; v < static_cast<int>(outer_surface.surface().vertices.size()); ++v) {
    const Vec3& place = outer_surface.surface().vertices[static_cast<std::size_t>(v)];
    Vec3 outward = Vec3::Zero();
    for (const int t : outer_surface.neighbours().triangles_at(v))
      outward += geometry::twice_area(outer_surface.surface(), t);
    const Ball ball{place + radius * outward.normalized(), radius};
    const auto node = nodes.facing(v, ball);
    const auto flat = nodes.facing(v, {ball.centre, 1e9});
    ASSERT_TRUE(node && flat);
    sum += node->facets - flat->facets;  // of 1 / R alone
    squares += flat->facets;             // of the skin's curvature alone
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_NEAR(squares / sum, radius / own, 0.02 * radius / own);  // normals from angles, h/R = 1/10
}

// The pressure that falls linearly from a node to its neighbours, over the distance from it, by a
// fine sum over squares; a node in the middle of the top, its triangles around it.
TEST(PressedNodes, own_surface_displacement_is_the_potential_of_a_hat) {
  const double cell = 1e-3;
  for (const auto pattern : {geometry::CellPattern::kuhn, geometry::CellPattern::mirrored}) {
    const auto outer_surface = box_surface(cell, pattern);
    const int vertex = vertex_at(outer_surface, Vec3(2e-3, 2e-3, 4e-3));
    const auto node = SurfaceNodes(outer_surface).facing(vertex, {Vec3(2e-3, 2e-3, 15e-3), 11e-3});
    ASSERT_TRUE(node);
    const Vec3 middle = outer_surface.surface().vertices[static_cast<std::size_t>(vertex)];
    constexpr int samples = 1000;
    double potential = 0.0;
    double force = 0.0;
    for (const int t : outer_surface.neighbours().triangles_at(vertex)) {
      const auto& corners = outer_surface.surface().triangles[static_cast<std::size_t>(t)];
      const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
      const auto corner = [&](long k) {
        return outer_surface.surface()
            .vertices[static_cast<std::size_t>(corners[static_cast<std::size_t>((at + k) % 3)])];
      };
      const Vec3 b = corner(1) - middle;
      const Vec3 c = corner(2) - middle;
      const double piece = 0.5 * b.cross(c).norm() / (samples * samples);
      const auto add = [&](double u, double v) {
        potential += piece * (1.0 - u - v) / (u * b + v * c).norm();
        force += piece * (1.0 - u - v);
      };
      for (int i = 0; i < samples; ++i)
        for (int j = 0; i + j < samples; ++j) {
          add((i + 1.0 / 3.0) / samples, (j + 1.0 / 3.0) / samples);
          if (i + j + 2 <= samples) add((i + 2.0 / 3.0) / samples, (j + 2.0 / 3.0) / samples);
        }
    }
    EXPECT_NEAR(node->area, force, 1e-9 * force);  // centroids are exact for what is linear
    EXPECT_NEAR(node->own, potential / force, 1e-3 * node->own);  // 1/r in the first of the steps
  }
}

}  // namespace
}  // namespace palpate::mechanics
