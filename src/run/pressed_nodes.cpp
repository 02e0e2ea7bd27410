// Sums over the triangles around a vertex, those that look towards the sphere.
#include "run/pressed_nodes.h"

#include <algorithm>
#include <cmath>

namespace palpate::run {
namespace {

// int over the triangle of p / r, r the distance from corner a where p is 1, with p = 0 on the side
// from b to c. Along every ray p falls linearly: int_0^rho (1 - r / rho) dr = rho / 2, and
// rho = d / cos(angle) to a side at distance d: d/2 (asinh(t_c / d) - asinh(t_b / d)), t along it.
double hat_potential(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = (c - b).normalized();
  const double t_b = (b - a).dot(along);
  const double t_c = (c - a).dot(along);
  const double d = (b - a - t_b * along).norm();
  return 0.5 * d * (std::asinh(t_c / d) - std::asinh(t_b / d));
}

}  // namespace

// Once for a skin: asinh() may differ between processors in its last bit.
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
        return skin.vertices[static_cast<std::size_t>(skin.triangles[t][k % 3])];
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
  constexpr double least_facing = 0.2;  // cosine: a side turned further away is not pressed
  PressedNode node;
  node.vertex = vertex;
  node.place = surface_->surface().vertices[static_cast<std::size_t>(vertex)];
  const Vec3 away = ball.centre - node.place;
  Vec3 normal = Vec3::Zero();
  double area = 0.0;
  for (const int t : surface_->neighbours().triangles_at(vertex)) {
    const Triangle& triangle = triangles_[static_cast<std::size_t>(t)];
    if (triangle.normal.dot(away) < least_facing * away.norm()) continue;
    const auto& corners = surface_->surface().triangles[static_cast<std::size_t>(t)];
    const auto corner = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) -
                                                 corners.begin());
    area += triangle.area;
    normal += triangle.area * surface_->corner_normal(t, corner);
    // A sphere of radius R stands off the straight side between two points that it goes through by
    // |s|^2 / (2 R) x_1 x_2 in weights x, and off a triangle by the sum over its sides, in the mean
    // 1/12 of it; a smooth skin likewise, whose normal turns by dn: dn . s.
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

}  // namespace palpate::run
