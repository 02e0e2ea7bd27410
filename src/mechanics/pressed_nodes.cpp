// Sums over the triangles around a vertex that face the sphere.
#include "mechanics/pressed_nodes.h"

#include <algorithm>
#include <cmath>

namespace palpate::mechanics {
namespace {

// The integral of p / r over the triangle, m: r is the distance from corner a, and p falls linearly
// from 1 at a to 0 on the side b c. Along a ray of length rho, int_0^rho (1 - r / rho) dr = rho
// / 2. With rho = d / cos(angle), d the distance of the side and t the coordinate along it, the
// integral is d/2 (asinh(t_c / d) - asinh(t_b / d)).
double hat_potential(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = (c - b).normalized();
  const double t_b = (b - a).dot(along);
  const double t_c = (c - a).dot(along);
  const double d = (b - a - t_b * along).norm();
  return 0.5 * d * (std::asinh(t_c / d) - std::asinh(t_b / d));
}

}  // namespace

// Computed before the first step, because asinh() may differ between processors in its last bit.
SkinNodes::SkinNodes(const geometry::SmoothSurface& surface) : surface_(&surface) {
  const geometry::Surface& skin = surface.surface();
  triangles_.resize(skin.triangles.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const int number = static_cast<int>(t);
    Triangle& triangle = triangles_[t];
    const Vec3 twice = geometry::twice_area(skin, number);
    triangle.area = 0.5 * twice.norm();
    triangle.normal = twice.normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const auto corner = [&](std::size_t k) -> const Vec3& {
        return skin.vertices[as_index(skin.triangles[t][k % 3])];
      };
      const Vec3 side = corner(next) - corner(i);
      triangle.squares += side.squaredNorm();
      triangle.turns +=
          side.dot(surface.corner_normal(number, next) - surface.corner_normal(number, i));
      triangle.own[i] = hat_potential(corner(i), corner(i + 1), corner(i + 2));
    }
  }
}

std::optional<PressedNode> SkinNodes::facing(int vertex, const Ball& ball) const {
  constexpr double least_facing = 0.2;  // cosine; triangles turned further away are not pressed
  PressedNode node;
  node.vertex = vertex;
  node.place = surface_->surface().vertices[as_index(vertex)];
  const Vec3 away = ball.centre - node.place;
  Vec3 normal = Vec3::Zero();
  double area = 0.0;
  for (const int t : surface_->neighbours().triangles_at(vertex)) {
    const Triangle& triangle = triangles_[as_index(t)];
    if (triangle.normal.dot(away) < least_facing * away.norm()) continue;
    const auto& corners = surface_->surface().triangles[as_index(t)];
    const auto corner =
        as_index(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
    area += triangle.area;
    normal += triangle.area * surface_->corner_normal(t, corner);
    // A sphere of radius R through the ends of a straight side s is |s|^2 / (2 R) x_1 x_2 above it,
    // with linear weights x. Above a triangle the heights of the sides add up, and the mean of
    // x_1 x_2 is 1/12. The surface's curvature adds dn . s to |s|^2 / R, docs/theory.md [gap].
    node.facets += triangle.area * (triangle.squares / ball.radius + triangle.turns) / 24.0;
    node.own += triangle.own[corner];
  }
  if (area <= 0.0) return std::nullopt;
  node.normal = normal.normalized();
  node.area = area / 3.0;
  node.facets /= area;
  node.own /= node.area;
  return node;
}

}  // namespace palpate::mechanics
