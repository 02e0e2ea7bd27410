// Computes principal curvatures in a tangent plane, and curvatures between vertices.
#include "geometry/curvature.h"

#include <cmath>

namespace palpate::geometry {

std::string_view explanation(StarStatus status) {
  switch (status) {
    case StarStatus::full: return "neighbours all around";
    case StarStatus::one_sided:
      return "a boundary or a sharp edge cuts the neighbours off on one side";
    case StarStatus::on_crease:
      return "the vertex lies on a sharp edge; say by a triangle which side is meant";
    case StarStatus::too_few: return "too few neighbours; refine the surface or take more rings";
    case StarStatus::degenerate:
      return "the neighbours do not span a surface; mend the triangles there";
  }
  return "";
}

std::array<Vec3, 2> tangent_axes(const Vec3& normal) {
  // The coordinate axis with the largest angle to the normal; the first of equal ones.
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(normal[i]) < std::abs(normal[axis])) axis = i;
  const Vec3 first = (Vec3::Unit(axis) - normal[axis] * normal).normalized();
  return {first, normal.cross(first)};
}

Curvature principal(const Vec3& normal, const std::array<double, 3>& matrix) {
  const auto [axis_x, axis_y] = tangent_axes(normal);
  const auto [xx, xy, yy] = matrix;
  const double mean = 0.5 * (xx + yy);
  const double half = 0.5 * (xx - yy);
  const double radius = std::sqrt(half * half + xy * xy);
  // The eigenvector of the eigenvalue mean + radius, in the form without cancellation.
  double x = half >= 0.0 ? half + radius : xy;
  double y = half >= 0.0 ? xy : radius - half;
  const double length = std::sqrt(x * x + y * y);
  x = length > 0.0 ? x / length : 1.0;
  y = length > 0.0 ? y / length : 0.0;
  return {.kappa_1 = mean + radius,
          .kappa_2 = mean - radius,
          .direction_1 = x * axis_x + y * axis_y,
          .direction_2 = x * axis_y - y * axis_x,
          .normal = normal};
}

Curvature turned_to(const Curvature& curvature, const Vec3& normal) {
  // A tangent t at n becomes t - (n' . t) (n + n') / (1 + n . n') at n'.  docs/theory.md [between]
  const Vec3 middle = (normal + curvature.normal) / (1.0 + normal.dot(curvature.normal));
  Curvature turned = curvature;
  turned.normal = normal;
  turned.direction_1 -= normal.dot(curvature.direction_1) * middle;
  turned.direction_2 -= normal.dot(curvature.direction_2) * middle;
  return turned;
}

Curvature between(const std::array<Curvature, 3>& corners, const std::array<double, 3>& weights) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) normal += weights[i] * corners[i].normal;
  normal.normalize();
  const std::array<Vec3, 2> axes = tangent_axes(normal);
  std::array<double, 3> matrix{};
  const auto add = [&](double kappa, const Vec3& direction) {
    const double x = direction.dot(axes[0]);
    const double y = direction.dot(axes[1]);
    matrix[0] += kappa * x * x;
    matrix[1] += kappa * x * y;
    matrix[2] += kappa * y * y;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Curvature corner = turned_to(corners[i], normal);
    add(weights[i] * corner.kappa_1, corner.direction_1);
    add(weights[i] * corner.kappa_2, corner.direction_2);
  }
  return principal(normal, matrix);
}

CurvatureEstimate CurvatureStars::at_vertex(const Surface& now, int vertex, int triangle) const {
  const int first = side_starts_[as_index(vertex)];
  const int last = side_starts_[as_index(vertex) + 1];
  if (first == last) return {};
  if (triangle >= 0) {
    for (const int side : corners_[as_index(triangle)])
      if (vertex_[as_index(side)] == vertex) return at_side(now, side);
  }
  if (last - first > 1) return {.status = StarStatus::on_crease, .curvature = {}};
  return at_side(now, first);
}

std::array<CurvatureEstimate, 3> CurvatureStars::at_corners(const Surface& now,
                                                            int triangle) const {
  std::array<CurvatureEstimate, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = at_side(now, corners_[as_index(triangle)][i]);
  return corners;
}

CurvatureEstimate between(const std::array<CurvatureEstimate, 3>& corners,
                          const std::array<double, 3>& weights) {
  CurvatureEstimate all{.status = StarStatus::full, .curvature = {}};
  const Curvature* known = nullptr;
  for (const CurvatureEstimate& corner : corners) {
    if (corner.status != StarStatus::full) all.status = corner.status;
    if (corner.known()) known = &corner.curvature;
  }
  if (known == nullptr) return all;
  if (all.status != StarStatus::full) all.status = StarStatus::one_sided;
  std::array<Curvature, 3> curvatures;
  std::array<double, 3> left{};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    curvatures[i] = corners[i].known() ? corners[i].curvature : *known;
    left[i] = corners[i].known() ? weights[i] : 0.0;
    sum += left[i];
  }
  // All weight is on corners without an estimate; the others are then used with equal weights.
  if (sum <= 0.0) left = {1.0, 1.0, 1.0};
  for (double& weight : left) weight /= sum > 0.0 ? sum : 3.0;
  all.curvature = between(curvatures, left);
  return all;
}

CurvatureEstimate CurvatureStars::at_side(const Surface& now, int side) const {
  return method_ == CurvatureMethod::quadric ? quadric(now, side) : taubin(now, side);
}

}  // namespace palpate::geometry
