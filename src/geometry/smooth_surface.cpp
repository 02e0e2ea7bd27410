// Computes corner normals up to creases, and feet of perpendiculars by Newton's method.
#include "geometry/smooth_surface.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace palpate::geometry {
namespace {

// The edge through which a change of the weights first leaves the triangle, and at which fraction.
struct Exit {
  double part = 1.0;
  int edge = -1;  // opposite to the corner whose weight became zero; -1: stays inside
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

SmoothSurface::SmoothSurface(Surface surface, double least)
    : surface_(std::move(surface)),
      neighbours_(surface_),
      crease_(surface_.triangles.size()),
      normals_(surface_.triangles.size()),
      vertex_normals_(vertex_normals(surface_)) {
  find_creases(least);
  find_blunt_edges();
  find_normals();
}

void SmoothSurface::find_creases(double least) {
  for (std::size_t t = 0; t < crease_.size(); ++t) {
    const Vec3 own = twice_area(surface_, static_cast<int>(t)).normalized();
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const int other = neighbours_.across(static_cast<int>(t))[edge];
      crease_[t][edge] = other < 0 || own.dot(twice_area(surface_, other).normalized()) < least;
    }
  }
}

// A curved surface bends at many lines, so that a flat part between them has one on either side. A
// line at which two flat parts meet that bend nowhere else, but for creases, is a blunt edge.
void SmoothSurface::find_blunt_edges() {
  constexpr double flat_cosine = 0.99996;  // half a degree
  constexpr double least_cosine = 0.9986;  // 3 degrees
  const int count = static_cast<int>(surface_.triangles.size());
  std::vector<Vec3> normals;
  for (int t = 0; t < count; ++t) normals.push_back(twice_area(surface_, t).normalized());
  const auto bend = [&](int t, std::size_t edge) {
    return normals[as_index(t)].dot(normals[as_index(neighbours_.across(t)[edge])]);
  };
  const auto ends = [&](int t, std::size_t edge) {
    const auto& corners = surface_.triangles[as_index(t)];
    return std::pair(surface_.vertices[as_index(corners[edge])],
                     surface_.vertices[as_index(corners[(edge + 1) % 3])]);
  };
  // Flat parts, and whether all their bent edges lie on one line.
  struct Part {
    std::optional<std::pair<Vec3, Vec3>> line;
    bool one = true;
  };
  std::vector<int> part_of(as_index(count), -1);
  std::vector<Part> parts;
  for (int first = 0; first < count; ++first) {
    if (part_of[as_index(first)] >= 0) continue;
    const int name = static_cast<int>(parts.size());
    Part part;
    part_of[as_index(first)] = name;
    std::vector<int> own{first};
    for (std::size_t i = 0; i < own.size(); ++i)
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (crease(own[i], edge)) continue;
        const int next = neighbours_.across(own[i])[edge];
        if (bend(own[i], edge) > flat_cosine) {
          if (part_of[as_index(next)] < 0) own.push_back(next);
          part_of[as_index(next)] = name;
          continue;
        }
        const auto [a, b] = ends(own[i], edge);
        if (!part.line) part.line.emplace(a, b);
        const Vec3 along = (part.line->second - part.line->first).normalized();
        const double near = 1e-3 * (part.line->second - part.line->first).norm();
        for (const Vec3& end : {a, b})
          part.one = part.one && along.cross(end - part.line->first).norm() < near;
      }
    parts.push_back(part);
  }
  std::vector<std::pair<int, std::size_t>> blunt;
  for (int t = 0; t < count; ++t)
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (crease(t, edge) || bend(t, edge) > least_cosine) continue;
      const int other = neighbours_.across(t)[edge];
      if (parts[as_index(part_of[as_index(t)])].one &&
          parts[as_index(part_of[as_index(other)])].one)
        blunt.emplace_back(t, edge);
    }
  for (const auto& [t, edge] : blunt) crease_[as_index(t)][edge] = true;
}

void SmoothSurface::find_normals() {
  for (std::size_t t = 0; t < normals_.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const int vertex = surface_.triangles[t][corner];
      // The triangles around the vertex that no crease separates from this triangle.
      std::vector<int> fan{static_cast<int>(t)};
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (std::size_t edge = 0; edge < 3; ++edge) {
          const auto& corners = surface_.triangles[as_index(fan[i])];
          if (crease(fan[i], edge) ||
              (corners[edge] != vertex && corners[(edge + 1) % 3] != vertex))
            continue;
          const int next = neighbours_.across(fan[i])[edge];
          if (std::ranges::find(fan, next) == fan.end()) fan.push_back(next);
        }
      std::ranges::sort(fan);  // the sum must not depend on the start triangle
      Vec3 sum = Vec3::Zero();
      for (const int triangle : fan) {
        const auto& corners = surface_.triangles[as_index(triangle)];
        sum += corner_angle(surface_, triangle, corner_of(corners, vertex)) *
               twice_area(surface_, triangle).normalized();
      }
      normals_[t][corner] = sum.normalized();
    }
    // On a flat part the normal is bitwise equal to that of the triangle.
    const Vec3 own = twice_area(surface_, static_cast<int>(t)).normalized();
    for (Vec3& normal : normals_[t])
      if ((normal - own).norm() < 1e-12) normal = own;
  }
}

Vec3 SmoothSurface::flat_position(const SurfacePoint& point) const {
  const auto& [a, b, c] = surface_.triangles[as_index(point.triangle)];
  // Not the sum of three products: on a flat at height z, rounding of the weights must not alter z.
  const Vec3& origin = surface_.vertices[as_index(a)];
  return origin + point.weights[1] * (surface_.vertices[as_index(b)] - origin) +
         point.weights[2] * (surface_.vertices[as_index(c)] - origin);
}

Vec3 SmoothSurface::position(const SurfacePoint& point) const {
  // p + 1/2 sum_i w_i [(v_i - p) . n_i] n_i                          docs/theory.md [smooth]
  const Vec3 flat = flat_position(point);
  Vec3 smooth = flat;
  for (std::size_t i = 0; i < 3; ++i) {
    const int vertex = surface_.triangles[as_index(point.triangle)][i];
    const Vec3& normal = corner_normal(point.triangle, i);
    const double rise = (surface_.vertices[as_index(vertex)] - flat).dot(normal);
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

SmoothSurface::ClosestPoint SmoothSurface::at(const Vec3& point, const SurfacePoint& where) const {
  ClosestPoint closest_point;
  closest_point.at = where;
  closest_point.position = position(where);
  closest_point.normal = normal(where);
  closest_point.height = (point - closest_point.position).dot(closest_point.normal);
  return closest_point;
}

// The normal that decides between outside and inside at a nearest point. The triangles' normals
// fail for this at edges sharper than a right angle: Baerentzen & Aanaes 2005.
Vec3 SmoothSurface::pseudo_normal(const SurfacePoint& point) const {
  constexpr double rounding = 1e-12;
  Vec3 sum = twice_area(surface_, point.triangle).normalized();
  for (std::size_t i = 0; i < 3; ++i) {
    if (point.weights[static_cast<Eigen::Index>(i)] >= 1.0 - rounding)
      return vertex_normals_[as_index(surface_.triangles[as_index(point.triangle)][i])];
    const int other = neighbours_.across(point.triangle)[i];
    if (point.weights[static_cast<Eigen::Index>((i + 2) % 3)] <= rounding && other >= 0)
      sum += twice_area(surface_, other).normalized();
  }
  return sum;
}

SmoothSurface::ClosestPoint SmoothSurface::flat_closest_point(const Vec3& point,
                                                              const Near& start) const {
  ClosestPoint closest_point;
  closest_point.at = {start.triangle, start.weights};
  closest_point.position = flat_position(closest_point.at);
  closest_point.normal = twice_area(surface_, start.triangle).normalized();
  const Vec3 away = point - closest_point.position;
  const double distance = away.norm();
  closest_point.height = away.dot(pseudo_normal(closest_point.at)) < 0.0 ? -distance : distance;
  // The perpendicular to an edge is inclined; above the triangle it is the triangle's normal.
  if (distance > 0.0 && closest_point.height > 0.0) closest_point.normal = away / distance;
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (crease(start.triangle, edge) &&
        start.weights[static_cast<Eigen::Index>((edge + 2) % 3)] <= 1e-12)
      closest_point.on_crease = true;
  return closest_point;
}

struct SmoothSurface::Crease {
  std::array<int, 2> ends{};                     // vertices
  std::array<int, 2> sides{};                    // triangles; -1 beyond a boundary
  std::array<std::array<Vec3, 2>, 2> normals{};  // of each side, at both ends
  double s = 0.0;                                // from the first end, 0 to 1
  Vec3 away = Vec3::Zero();                      // m, from the curve to the point
  Vec3 along = Vec3::Zero();                     // m, the curve's derivative

  [[nodiscard]] std::size_t count() const { return sides[1] < 0 ? 1 : 2; }
};

// The crease's curve. Each of the two sides displaces the edge by s (1 - s) / 2 times a vector; the
// curve has the components of both vectors along the normals of their sides.
//                                                                           docs/theory.md [smooth]
SmoothSurface::Crease SmoothSurface::nearest_on_crease(const Vec3& point, int triangle,
                                                       std::size_t edge, double start) const {
  const auto& corners = surface_.triangles[as_index(triangle)];
  Crease crease;
  crease.ends = {corners[edge], corners[(edge + 1) % 3]};
  crease.sides = {triangle, neighbours_.across(triangle)[edge]};
  crease.s = start;
  const Vec3& from = surface_.vertices[as_index(crease.ends[0])];
  const Vec3 side = surface_.vertices[as_index(crease.ends[1])] - from;
  std::array<Vec3, 2> middle;
  std::array<double, 2> rise{};
  for (std::size_t k = 0; k < crease.count(); ++k) {
    for (std::size_t end = 0; end < 2; ++end)
      crease.normals[k][end] =
          corner_normal(crease.sides[k],
                        corner_of(surface_.triangles[as_index(crease.sides[k])], crease.ends[end]));
    const auto& [n0, n1] = crease.normals[k];
    middle[k] = (n0 + n1).normalized();
    rise[k] = middle[k].dot(side.dot(n1) * n1 - side.dot(n0) * n0);
  }
  Vec3 bulge = rise[0] * middle[0];
  if (crease.count() == 2) {
    const double both = middle[0].dot(middle[1]);
    const double determinant = 1.0 - both * both;
    bulge.setZero();  // the two sides are nearly folded onto each other
    if (determinant > 0.1)
      bulge = ((rise[0] - both * rise[1]) * middle[0] + (rise[1] - both * rise[0]) * middle[1]) /
              determinant;
  }
  constexpr int most_steps = 50;
  for (int i = 0; i < most_steps; ++i) {
    const double s = crease.s;
    crease.away = point - (from + s * side + 0.5 * s * (1.0 - s) * bulge);
    crease.along = side + 0.5 * (1.0 - 2.0 * s) * bulge;
    const double slope = crease.along.squaredNorm() + crease.away.dot(bulge);
    const double move =
        crease.away.dot(crease.along) / (slope > 0.0 ? slope : crease.along.squaredNorm());
    crease.s = std::clamp(s + move, 0.0, 1.0);
    if (std::abs(crease.s - s) <= 1e-15) break;
  }
  return crease;
}

SmoothSurface::ClosestPoint SmoothSurface::edge_closest_point(const Vec3& point,
                                                              const SurfacePoint& start,
                                                              std::size_t edge) const {
  Crease crease = nearest_on_crease(point, start.triangle, edge,
                                    start.weights[static_cast<Eigen::Index>((edge + 1) % 3)]);
  // At an end, the crease may continue along other edges.
  if (crease.s == 0.0 || crease.s == 1.0) {
    const int vertex = crease.ends[crease.s == 0.0 ? 0 : 1];
    for (const int triangle : neighbours_.triangles_at(vertex))
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& corners = surface_.triangles[as_index(triangle)];
        const bool begins = corners[i] == vertex;
        if (!this->crease(triangle, i) || (!begins && corners[(i + 1) % 3] != vertex)) continue;
        const Crease next = nearest_on_crease(point, triangle, i, begins ? 0.0 : 1.0);
        if (next.away.squaredNorm() < crease.away.squaredNorm()) crease = next;
      }
  }
  const double s = crease.s;
  const auto place = [&](int triangle) {
    const auto& corners = surface_.triangles[as_index(triangle)];
    SurfacePoint at{triangle, Vec3::Zero()};
    at.weights[static_cast<Eigen::Index>(corner_of(corners, crease.ends[0]))] = 1.0 - s;
    at.weights[static_cast<Eigen::Index>(corner_of(corners, crease.ends[1]))] = s;
    return at;
  };
  ClosestPoint closest_point;
  closest_point.on_crease = true;
  closest_point.at = place(crease.sides[0]);
  closest_point.position =
      flat_position(closest_point.at);  // on the triangles, where loads can act
  std::array<double, 2> past{};         // distance of the point beyond each side
  for (std::size_t k = 0; k < crease.count(); ++k) {
    const auto& [n0, n1] = crease.normals[k];
    const Vec3 normal = ((1.0 - s) * n0 + s * n1).normalized();
    past[k] = crease.away.dot(crease.along.cross(normal)) * (k == 0 ? 1.0 : -1.0);
    if (past[k] > 0.0 || s == 0.0 || s == 1.0) continue;
    // Between the edge and the curve, the side is continued with its normal there.
    closest_point.at = place(crease.sides[k]);
    closest_point.normal = normal;
    closest_point.height = crease.away.dot(normal);
    return closest_point;
  }
  past = {std::max(0.0, past[0]), std::max(0.0, past[1])};
  if (crease.count() == 2 && past[0] > 0.0) {
    closest_point.beyond = place(crease.sides[1]);
    closest_point.turned = past[0] / (past[0] + past[1]);
  }
  closest_point.normal = pseudo_normal(closest_point.at).normalized();
  const double distance = crease.away.norm();
  closest_point.height = crease.away.dot(closest_point.normal) < 0.0 ? -distance : distance;
  if (distance > 0.0) closest_point.normal = crease.away / closest_point.height;
  return closest_point;
}

SmoothSurface::ClosestPoint SmoothSurface::closest_point(const Vec3& point,
                                                         const Near& start) const {
  const ClosestPoint found = followed_closest_point(point, start);
  const ClosestPoint flat = flat_closest_point(point, start);
  // Beyond a rim, Newton's method can end below a wall: the point is behind the wall's plane, but
  // outside the body. The smooth surface is nearer to its triangles than their edges are long.
  const auto& [a, b, c] = surface_.triangles[as_index(start.triangle)];
  const Vec3& corner = surface_.vertices[as_index(a)];
  const double size = (surface_.vertices[as_index(b)] - corner).norm() +
                      (surface_.vertices[as_index(c)] - corner).norm();
  return std::abs(found.height - flat.height) <= size ? found : flat;
}

SmoothSurface::ClosestPoint SmoothSurface::followed_closest_point(const Vec3& point,
                                                                  const Near& start) const {
  constexpr int most_moves = 60;
  constexpr double nudge = 1e-6;  // of the weights, for the derivative
  SurfacePoint here{start.triangle, start.weights};
  int stuck = 0;
  for (int move_number = 0; move_number < most_moves; ++move_number) {
    const auto& [a, b, c] = surface_.triangles[as_index(here.triangle)];
    const Vec3 side_b = surface_.vertices[as_index(b)] - surface_.vertices[as_index(a)];
    const Vec3 side_c = surface_.vertices[as_index(c)] - surface_.vertices[as_index(a)];
    // The part of (point - x) across the normal, along two sides of the triangle.
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
      return flat_closest_point(point, start);
    const Eigen::Vector2d change = -(slope.inverse() * now);
    const Vec3 move(-change[0] - change[1], change[0], change[1]);
    if (!move.allFinite()) return flat_closest_point(point, start);
    const Exit exit = first_exit(here.weights, move);
    here.weights += exit.part * move;
    if (exit.edge < 0) {
      if (move.cwiseAbs().maxCoeff() <= 1e-13) return at(point, here);
      stuck = 0;
      continue;
    }
    const auto edge = as_index(exit.edge);
    if (crease(here.triangle, edge)) {
      // A long move may have overshot; only a move that starts at the crease ends there.
      if (exit.part <= 1e-12 || ++stuck > 6) return edge_closest_point(point, here, edge);
      continue;
    }
    // Continue in the next triangle, from the same point of the edge.
    const int next = neighbours_.across(here.triangle)[edge];
    const auto& old_corners = surface_.triangles[as_index(here.triangle)];
    const auto& new_corners = surface_.triangles[as_index(next)];
    SurfacePoint there{next, Vec3::Zero()};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (new_corners[i] == old_corners[k] && k != (edge + 2) % 3)
          there.weights[static_cast<Eigen::Index>(i)] =
              std::max(0.0, here.weights[static_cast<Eigen::Index>(k)]);
    there.weights /= there.weights.sum();
    // Repeated crossings of the same edge mean that the foot is on it.
    stuck = exit.part <= 1e-12 ? stuck + 1 : 0;
    if (stuck > 6) return at(point, here);
    here = there;
  }
  return at(point, here);
}

}  // namespace palpate::geometry
