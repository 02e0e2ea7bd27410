// Triangles of a body's faces, inner ones too, that are cut at planes and refined.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "geometry/surface.h"

namespace palpate::solid {

// A plane normal to an axis, or to another direction. Points of the first have its coordinate to
// the last bit, those of the second within rounding.
struct Plane {
  int axis = 0;
  double at = 0.0;                    // m, along the axis or the direction
  std::optional<Vec3> inclined = {};  // unit normal

  [[nodiscard]] double beyond(const Vec3& point) const {
    constexpr double rounding = 1e-13;  // m
    if (!inclined) return point[axis] - at;
    const double above = inclined->dot(point) - at;
    return std::abs(above) < rounding ? 0.0 : above;
  }
  void place(Vec3& point) const {
    if (inclined)
      point -= beyond(point) * *inclined;
    else
      point[axis] = at;
  }
};

// A point near `point` on a surface, given by its projection, and on planes.
[[nodiscard]] Vec3 placed_onto(Vec3 point, const std::function<Vec3(const Vec3&)>& onto,
                               std::span<const Plane> planes);

// Any number of triangles may meet at an edge. Every triangle has a number, which its parts keep.
class SurfaceNet {
 public:
  // The true place (m) of a point near triangles of these numbers.
  using Onto = std::function<Vec3(const Vec3& point, std::span<const int> numbers)>;

  SurfaceNet(geometry::Surface surface, std::vector<int> numbers, Onto onto);

  // From now on edges are split only, so that flat triangles that do not cross never do.
  void only_split() { movable_ = false; }

  // Makes edges along a plane: moves vertices that are near it, and splits edges that cross it.
  // Vertices on it then have its coordinate exactly, also after refine().
  void cut(const Plane& plane);
  // Removes the triangles of which a part lies below the plane, which has been cut.
  void drop_below(const Plane& plane);
  // Splits edges that are longer than `size` says for their middles, the longest first, turns edges
  // between triangles of one number where that makes them rounder, and moves vertices between such
  // triangles to the middle of their neighbours. Turns and moves by which triangles of the number
  // `whole` would cross each other are excluded; these form a manifold.
  void refine(const std::function<double(const Vec3&)>& size, std::optional<int> whole = {});

  // Adds a vertex on no triangle; returns its number.
  int add(const Vec3& point);
  void add(const std::array<int, 3>& triangle, int number);

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }
  // All edges with both ends on a plane, ascending.
  [[nodiscard]] std::vector<std::array<int, 2>> edges_on(const Plane& plane) const;

 private:
  using Edge = std::array<int, 2>;  // ascending
  [[nodiscard]] Vec3 placed(const Edge& edge, double share, const Plane* also = nullptr) const;
  int split(const Edge& edge, const Vec3& at);
  void connect(int triangle);
  void disconnect(int triangle);
  void turn_edges();
  void smooth(double share);
  void without_crossings(std::optional<int> whole, const std::function<void(SurfaceNet&)>& step);
  [[nodiscard]] bool crease(const Edge& edge) const;
  [[nodiscard]] Vec3 twice_area(const std::array<int, 3>& triangle) const;  // m^2, outwards

  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> numbers_;
  std::map<Edge, std::vector<int>> at_;  // triangles at every edge
  std::vector<Plane> planes_;
  Onto onto_;
  bool movable_ = true;
  std::vector<char> kept_;  // vertices that stay, with the edges of their triangles; or empty
};

}  // namespace palpate::solid
