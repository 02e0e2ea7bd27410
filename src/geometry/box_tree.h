// A tree of bounding boxes around a surface's triangles, refitted as the surface moves.
#pragma once

#include <span>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// The point of triangle (a, b, c) that is nearest to `point`, as weights of the corners. Ericson
// 2005, Real-Time Collision Detection, section 5.1.5.
[[nodiscard]] Vec3 nearest_weights(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

// Result of a query: the nearest point of a triangle.
struct Near {
  double distance_squared = 0.0;  // m^2, to the flat triangle
  int triangle = -1;
  Vec3 weights = Vec3::Zero();  // of the nearest point
};

class BoxTree {
 public:
  // Copies the triangles; at least one is needed.
  explicit BoxTree(const Surface& surface);

  // Updates all boxes to new positions of the vertices (m), in time linear in the triangles.
  void refit(std::span<const Vec3> vertices);

  // Stores all triangles within `radius` (m) of `point` in `found`, in ascending order.
  void within(const Vec3& point, double radius, std::vector<Near>& found) const;

  // The nearest triangle; if several are equally near, the one with the lowest index.
  [[nodiscard]] Near nearest(const Vec3& point) const;

  // How far (m) from `point` the first triangle along a unit vector is that lies beyond `least`
  // (m); infinity if there is none.
  [[nodiscard]] double first_along(const Vec3& point, const Vec3& direction, double least) const;

 private:
  struct Box {
    Vec3 low, high;
    int first = 0;  // leaf: index into order_; branch: its left child, followed by the right one
    int count = 0;  // number of triangles in a leaf; 0 for a branch
  };

  void split(int box, int first, int count, const std::vector<Vec3>& centres);
  void fit(Box& box) const;
  [[nodiscard]] Near near(const Vec3& point, int triangle) const;

  std::vector<Vec3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> order_;
  std::vector<Box> boxes_;  // children come after their parents
};

}  // namespace palpate::geometry
