// A tree of boxes around a surface's triangles: built once, refitted as the surface moves.
#pragma once

#include <span>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// The point of triangle (a, b, c) nearest to `point`, as the weights of its corners.
// Ericson 2005, Real-Time Collision Detection, section 5.1.5.
[[nodiscard]] Vec3 nearest_weights(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

// What a query found: squared distance first, so that ties are broken by the number.
struct Near {
  double distance_squared = 0.0;  // m^2, to the flat triangle
  int triangle = -1;
  Vec3 weights = Vec3::Zero();  // of the nearest point
};

class BoxTree {
 public:
  // Keeps a copy of the triangles; `surface` need not outlive it. Needs at least one triangle.
  explicit BoxTree(const Surface& surface);

  // The vertices have moved: every box is made to fit again, in time linear in the triangles.
  void refit(std::span<const Vec3> vertices);

  // Every triangle within `radius` (m) of `point`, ascending by number, into `found`.
  void within(const Vec3& point, double radius, std::vector<Near>& found) const;

  // The nearest triangle; of several the one with the lowest number.
  [[nodiscard]] Near nearest(const Vec3& point) const;

 private:
  struct Box {
    Vec3 low, high;
    int first = 0;  // leaf: of order_; branch: its left child, the right one follows
    int count = 0;  // of triangles in a leaf; 0 for a branch
  };

  void split(int box, int first, int count, const std::vector<Vec3>& centres);
  void fit(Box& box) const;
  [[nodiscard]] Near near(const Vec3& point, int triangle) const;

  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> order_;
  std::vector<Box> boxes_;  // children stand behind their parents
};

}  // namespace palpate::geometry
