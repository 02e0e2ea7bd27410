// Corner normals that stop at creases, and Newton's method for the foot of a perpendicular.
#include "geometry/smooth_surface.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::geometry {
namespace {

// The edge that a move of the weights from inside meets first, and after which part of it.
struct Exit {
  double part = 1.0;
  int edge = -1;  // opposite to the corner whose weight vanished; -1: stays inside
};

Exit first_exit(const Vec3& weights, const Vec3& move) {
  Exit exit;
  for (int corner = 0; corner < 3; ++corner) {
    if (move[corner] >= 0.0) continue;
    const double part = std::max(0.0, weights[corner]) / -move[corner];
    if (part < exit.part) exit = {part, (corner + 1) % 3};
  }
  return exit;
}

}  // namespace

SmoothSurface::SmoothSurface(Surface surface)
    : surface_(std::move(surface)),
      neighbours_(surface_),
      crease_(surface_.triangles.size()),
      normals_(surface_.triangles.size()) {
  find_creases();
  find_normals();
}

void SmoothSurface::find_creases() {
  for (std::size_t t = 0; t < crease_.size(); ++t) {
    const Vec3 own = twice_area(surface_, static_cast<int>(t)).normalized();
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const int other = neighbours_.across(static_cast<int>(t))[edge];
      crease_[t][edge] =
          other < 0 || own.dot(twice_area(surface_, other).normalized()) < crease_cosine;
    }
  }
}

void SmoothSurface::find_normals() {
  for (std::size_t t = 0; t < normals_.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const int vertex = surface_.triangles[t][corner];
      // The fan around the vertex, as far as no crease parts it from this triangle.
      std::vector<int> fan{static_cast<int>(t)};
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (std::size_t edge = 0; edge < 3; ++edge) {
          const auto& corners = surface_.triangles[static_cast<std::size_t>(fan[i])];
          if (crease(fan[i], edge) ||
              (corners[edge] != vertex && corners[(edge + 1) % 3] != vertex))
            continue;
          const int next = neighbours_.across(fan[i])[edge];
          if (std::find(fan.begin(), fan.end(), next) == fan.end()) fan.push_back(next);
        }
      std::sort(fan.begin(), fan.end());  // the sum must not depend on where the walk began
      Vec3 sum = Vec3::Zero();
      for (const int triangle : fan) {
        const auto& corners = surface_.triangles[static_cast<std::size_t>(triangle)];
        const auto here = static_cast<std::size_t>(
            std::find(corners.begin(), corners.end(), vertex) - corners.begin());
        const auto point = [&](std::size_t i) -> const Vec3& {
          return surface_.vertices[static_cast<std::size_t>(corners[i % 3])];
        };
        const Vec3 left = point(here + 1) - point(here);
        const Vec3 right = point(here + 2) - point(here);
        const double angle = std::atan2(left.cross(right).norm(), left.dot(right));
        sum += angle * twice_area(surface_, triangle).normalized();
      }
      normals_[t][corner] = sum.normalized();
    }
    // A flat part keeps its triangle's own normal to the last bit.
    const Vec3 own = twice_area(surface_, static_cast<int>(t)).normalized();
    for (Vec3& normal : normals_[t])
      if ((normal - own).norm() < 1e-12) normal = own;
  }
}

Vec3 SmoothSurface::flat_position(const SurfacePoint& point) const {
  const auto& [a, b, c] = surface_.triangles[static_cast<std::size_t>(point.triangle)];
  return point.weights[0] * surface_.vertices[static_cast<std::size_t>(a)] +
         point.weights[1] * surface_.vertices[static_cast<std::size_t>(b)] +
         point.weights[2] * surface_.vertices[static_cast<std::size_t>(c)];
}

Vec3 SmoothSurface::position(const SurfacePoint& point) const {
  // p + 1/2 sum_i w_i [(v_i - p) . n_i] n_i                              docs/theory.md (42)
  const Vec3 flat = flat_position(point);
  Vec3 smooth = flat;
  for (std::size_t i = 0; i < 3; ++i) {
    const int vertex = surface_.triangles[static_cast<std::size_t>(point.triangle)][i];
    const Vec3& normal = corner_normal(point.triangle, i);
    const double rise = (surface_.vertices[static_cast<std::size_t>(vertex)] - flat).dot(normal);
    smooth += 0.5 * point.weights[static_cast<Eigen::Index>(i)] * rise * normal;
  }
  return smooth;
}

Vec3 SmoothSurface::normal(const SurfacePoint& point) const {
  return (point.weights[0] * corner_normal(point.triangle, 0) +
          point.weights[1] * corner_normal(point.triangle, 1) +
          point.weights[2] * corner_normal(point.triangle, 2))
      .normalized();
}

SmoothSurface::Foot SmoothSurface::at(const Vec3& point, const SurfacePoint& where) const {
  Foot foot;
  foot.at = where;
  foot.position = position(where);
  foot.normal = normal(where);
  foot.height = (point - foot.position).dot(foot.normal);
  return foot;
}

SmoothSurface::Foot SmoothSurface::flat_foot(const Vec3& point, const Near& start) const {
  Foot foot;
  foot.at = {start.triangle, start.weights};
  foot.position = flat_position(foot.at);
  foot.normal = twice_area(surface_, start.triangle).normalized();
  const Vec3 away = point - foot.position;
  const double distance = away.norm();
  foot.height = away.dot(foot.normal) < 0.0 ? -distance : distance;
  // Beside an edge the perpendicular leans; in its plane it is the triangle's own.
  if (distance > 0.0 && foot.height > 0.0) foot.normal = away / distance;
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (crease(start.triangle, edge) &&
        start.weights[static_cast<Eigen::Index>((edge + 2) % 3)] <= 1e-12)
      foot.on_crease = true;
  return foot;
}

SmoothSurface::Foot SmoothSurface::foot(const Vec3& point, const Near& start) const {
  constexpr int most_moves = 60;
  constexpr double nudge = 1e-6;  // of the weights, for the derivative
  SurfacePoint here{start.triangle, start.weights};
  int stuck = 0;
  for (int move_number = 0; move_number < most_moves; ++move_number) {
    const auto& [a, b, c] = surface_.triangles[static_cast<std::size_t>(here.triangle)];
    const Vec3 side_b = surface_.vertices[static_cast<std::size_t>(b)] -
                        surface_.vertices[static_cast<std::size_t>(a)];
    const Vec3 side_c = surface_.vertices[static_cast<std::size_t>(c)] -
                        surface_.vertices[static_cast<std::size_t>(a)];
    // What is left of (point - x) across the normal, along two sides of the triangle.
    const auto lean = [&](const Vec3& weights) -> Eigen::Vector2d {
      const SurfacePoint where{here.triangle, weights};
      const Vec3 away = point - position(where);
      const Vec3 up = normal(where);
      const Vec3 rest = away - away.dot(up) * up;
      return {rest.dot(side_b), rest.dot(side_c)};
    };
    const Eigen::Vector2d now = lean(here.weights);
    Eigen::Matrix2d slope;
    slope.col(0) = (lean(here.weights + Vec3(-nudge, nudge, 0.0)) - now) / nudge;
    slope.col(1) = (lean(here.weights + Vec3(-nudge, 0.0, nudge)) - now) / nudge;
    const double determinant = slope.determinant();
    if (!(std::abs(determinant) > 1e-30 * side_b.squaredNorm() * side_c.squaredNorm()))
      return flat_foot(point, start);
    const Eigen::Vector2d change = -(slope.inverse() * now);
    const Vec3 move(-change[0] - change[1], change[0], change[1]);
    if (!move.allFinite()) return flat_foot(point, start);
    const Exit exit = first_exit(here.weights, move);
    here.weights += exit.part * move;
    if (exit.edge < 0) {
      if (move.cwiseAbs().maxCoeff() <= 1e-13) return at(point, here);
      stuck = 0;
      continue;
    }
    const auto edge = static_cast<std::size_t>(exit.edge);
    if (crease(here.triangle, edge)) return flat_foot(point, start);
    // Across the edge, at the same point of it.
    const int next = neighbours_.across(here.triangle)[edge];
    const auto& old_corners = surface_.triangles[static_cast<std::size_t>(here.triangle)];
    const auto& new_corners = surface_.triangles[static_cast<std::size_t>(next)];
    SurfacePoint there{next, Vec3::Zero()};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (new_corners[i] == old_corners[k] && k != (edge + 2) % 3)
          there.weights[static_cast<Eigen::Index>(i)] =
              std::max(0.0, here.weights[static_cast<Eigen::Index>(k)]);
    there.weights /= there.weights.sum();
    // Sent to and fro across an edge: the foot lies on it.
    stuck = exit.part <= 1e-12 ? stuck + 1 : 0;
    if (stuck > 6) return at(point, here);
    here = there;
  }
  return at(point, here);
}

}  // namespace palpate::geometry
