// A triangulated surface interpreted as the smooth surface that it samples, with creases.
#pragma once

#include <array>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/surface.h"

namespace palpate::geometry {

// A point on a surface: a triangle and the weights of its corners, which sum to 1.
struct SurfacePoint {
  int triangle = -1;
  Vec3 weights = Vec3::Zero();
};

// An edge between triangles whose normals differ by more than this is a crease; so is a boundary,
// and a line at which two flat parts meet that bend nowhere else.
inline constexpr double crease_cosine = 0.766044443118978;  // 40 degrees

// Normals vary linearly over a triangle between those of its corners, and points are displaced
// accordingly: Phong tessellation (Boubekeur & Alexa 2008) with the factor 1/2, which follows a
// quadratic surface to second order. Flat parts are identical to the triangles.
//                                                                           docs/theory.md [smooth]
class SmoothSurface {
 public:
  // With `least` above 1 every edge is a crease, so that the surface is its triangles.
  explicit SmoothSurface(Surface surface, double least = crease_cosine);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }

  // Edge i of a triangle runs from its corner i to the next.
  [[nodiscard]] bool crease(int triangle, std::size_t edge) const {
    return crease_[as_index(triangle)][edge];
  }

  // The unit normal at a triangle's corner, on the triangle's side of any crease.
  [[nodiscard]] const Vec3& corner_normal(int triangle, std::size_t corner) const {
    return normals_[as_index(triangle)][corner];
  }

  [[nodiscard]] Vec3 flat_position(const SurfacePoint& point) const;  // m, on the triangle
  [[nodiscard]] Vec3 position(const SurfacePoint& point) const;       // m, on the smooth surface
  [[nodiscard]] Vec3 normal(const SurfacePoint& point) const;         // unit, outwards

  // The foot of the perpendicular from a point.
  struct ClosestPoint {
    SurfacePoint at;
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();
    double height = 0.0;  // m, of the point above the surface; negative inside
    bool on_crease = false;
    // On a crease: the same point as part of the other side, and how far the perpendicular has
    // turned from this side's normal (0) to the other side's (1).
    SurfacePoint beyond;
    double turned = 0.0;
  };
  // Searches for the foot from the nearest point of the flat triangles. If the search ends at a
  // crease, the foot is on the crease's curve. Continuous in `point` until another foot is nearer.
  [[nodiscard]] ClosestPoint closest_point(const Vec3& point, const Near& start) const;

 private:
  [[nodiscard]] ClosestPoint followed_closest_point(const Vec3& point, const Near& start) const;
  [[nodiscard]] ClosestPoint flat_closest_point(const Vec3& point, const Near& start) const;
  // The smooth curve of the crease at edge `edge` of a triangle, and its point nearest to `point`.
  struct Crease;
  [[nodiscard]] Crease nearest_on_crease(const Vec3& point, int triangle, std::size_t edge,
                                         double start) const;
  [[nodiscard]] ClosestPoint edge_closest_point(const Vec3& point, const SurfacePoint& start,
                                                std::size_t edge) const;
  [[nodiscard]] ClosestPoint at(const Vec3& point, const SurfacePoint& where) const;
  [[nodiscard]] Vec3 pseudo_normal(const SurfacePoint& point) const;
  void find_creases(double least);
  void find_blunt_edges();
  void find_normals();

  Surface surface_;
  Neighbours neighbours_;
  std::vector<std::array<bool, 3>> crease_;
  std::vector<std::array<Vec3, 3>> normals_;
  std::vector<Vec3> vertex_normals_;  // averaged over creases too
};

}  // namespace palpate::geometry
