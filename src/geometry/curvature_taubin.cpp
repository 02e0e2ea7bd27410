// Computes curvature by the paper's voting of normals, Chen 2007 eq. (6)-(9), with its sign.
#include <cmath>

#include "geometry/curvature.h"

namespace palpate::geometry {

CurvatureEstimate CurvatureStars::taubin(const Surface& now, int side) const {
  const Vec3& origin = position(now, side);
  const Vec3 normal = this->normal(now, side).normalized();
  const auto [axis_x, axis_y] = tangent_axes(normal);
  std::array<double, 3> vote{};
  double weights = 0.0;
  for (const int other : star_of(side)) {
    const Vec3 d = position(now, other) - origin;
    const Vec3 tangent = (d - normal.dot(d) * normal).normalized();
    // n_i is the neighbour's normal in the plane of N_p and T_i. Its angle from N_p towards T_i is
    // positive where the surface is convex; the paper's arccos is always positive.
    const Vec3 other_normal = this->normal(now, other);
    double angle = std::atan2(other_normal.dot(tangent), other_normal.dot(normal));
    if (method_ == CurvatureMethod::taubin_unsigned) angle = std::abs(angle);
    // Arc length divided by chord; exact on a sphere.
    const double half = 0.5 * angle;
    const double arc = d.norm() * (half != 0.0 ? half / std::sin(half) : 1.0);
    const double kappa = angle / arc;
    double weight = 0.0;
    for (const int triangle : triangles_of(other)) weight += twice_area(now, triangle).norm();
    const double x = tangent.dot(axis_x);
    const double y = tangent.dot(axis_y);
    vote[0] += weight * kappa * x * x;
    vote[1] += weight * kappa * x * y;
    vote[2] += weight * kappa * y * y;
    weights += weight;
  }
  if (star_of(side).size() < 3) return {.status = StarStatus::too_few, .curvature = {}};
  if (!(weights > 0.0) || !std::isfinite(vote[0] + vote[1] + vote[2]))
    return {.status = StarStatus::degenerate, .curvature = {}};
  // k_1 = 3 m_1 - m_2 and k_2 = 3 m_2 - m_1: the matrix 4 M - trace(M) I.  docs/theory.md [taubin]
  const double trace = vote[0] + vote[2];
  const double scale = 1.0 / weights;
  return {.status = status_of(side),
          .curvature = principal(normal, {scale * (4.0 * vote[0] - trace), scale * 4.0 * vote[1],
                                          scale * (4.0 * vote[2] - trace)})};
}

}  // namespace palpate::geometry
