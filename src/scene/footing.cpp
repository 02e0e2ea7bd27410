// Moments of the area of the triangles that are held.
#include "scene/footing.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace palpate::scene {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Footing footing(const geometry::Surface& surface, std::optional<double> base_height) {
  const auto corner = [&](const std::array<int, 3>& triangle, std::size_t k) -> const Vec3& {
    return surface.vertices[as_index(triangle[k])];
  };
  const auto highest = [&](const std::array<int, 3>& one) {
    return std::max({corner(one, 0).z(), corner(one, 1).z(), corner(one, 2).z()});
  };
  const auto middle = [&](const std::array<int, 3>& one) {
    return (corner(one, 0).z() + corner(one, 1).z() + corner(one, 2).z()) / 3.0;
  };
  const auto [low, high] =
      std::minmax_element(surface.vertices.begin(), surface.vertices.end(),
                          [](const Vec3& one, const Vec3& other) { return one.z() < other.z(); });
  Footing found;
  found.level = low->z();
  const double height = high->z() - low->z();
  const double flat = 1e-9 * height;
  const bool stands_flat =
      std::any_of(surface.triangles.begin(), surface.triangles.end(),
                  [&](const auto& one) { return highest(one) <= found.level + flat; });
  const auto lowest = std::min_element(
      surface.triangles.begin(), surface.triangles.end(),
      [&](const auto& one, const auto& other) { return middle(one) < middle(other); });
  const double held = base_height ? *base_height - found.level : (stands_flat ? 0.0 : 0.1 * height);
  // At least one triangle of a coarse surface.
  const double top = std::max(found.level + held + flat, middle(*lowest));

  double area = 0.0;
  Vector2d first = Vector2d::Zero();
  Matrix2d second = Matrix2d::Zero();
  for (const auto& triangle : surface.triangles) {
    if (middle(triangle) > top) continue;
    const Vector2d a = corner(triangle, 0).head<2>(), b = corner(triangle, 1).head<2>(),
                   c = corner(triangle, 2).head<2>();
    const double own = 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
    area += own;
    first += own / 3.0 * (a + b + c);
    for (const Vector2d& edge : {Vector2d(0.5 * (a + b)), Vector2d(0.5 * (b + c)),
                                 Vector2d(0.5 * (c + a))})  // exact for squares
      second += own / 3.0 * edge * edge.transpose();
  }
  area = std::max(area, 1e-12 * height * height);
  found.centre = first / area;
  const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(second / area -
                                                     found.centre * found.centre.transpose());
  found.direction = axes.eigenvectors().col(0);
  found.semi_axes = (2.0 * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt()).cwiseMax(1e-3 * height);
  return found;
}

Footing::Compliance Footing::under(const Vec3& position, const Vec3& normal) const {
  // Fitted with tests/accuracy/standing_bodies.py; a rigid circle has 1 and 3/2.
  constexpr double sinks = 0.4, rocks = 2.25;
  const double p = semi_axes[0], q = semi_axes[1];
  const double upright = std::max(0.1, normal.z());
  // Where the line of the force meets the base.
  const Vector2d aside =
      position.head<2>() - (position.z() - level) / upright * normal.head<2>() - centre;
  const double u = aside.dot(direction) / p;
  const double v = (direction.x() * aside.y() - direction.y() * aside.x()) / q;
  return {sinks / std::sqrt(p * q), rocks * (u * u / q + v * v / p)};
}

}  // namespace palpate::scene
