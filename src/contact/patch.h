// The patch that a sphere presses on a surface, and its pressure spread over the vertices there.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/smooth_surface.h"

namespace palpate::contact {

// An ellipse in the tangent plane of a surface point; the pressure over it is Hertz's.
struct Patch {
  geometry::SurfacePoint at;
  Vec3 position = Vec3::Zero();   // m
  Vec3 normal = Vec3::UnitZ();    // unit, out of the tissue
  Vec3 axis = Vec3::UnitX();      // unit, tangential, along the semi-axis a
  double a = 0.0, b = 0.0;        // m, semi-axes
  geometry::SurfacePoint beyond;  // as in SmoothSurface::Foot
  double turned = 0.0;

  [[nodiscard]] double radius() const;  // m, of the circle of the same area: sqrt(a b)
};

// Of a patch, at most: three corners of one triangle a quadrature point.
inline constexpr std::size_t most_shares = 288;

// Shares of a force on the surface's vertices. They sum to 1, and the point of the patch is their
// centre in the tangent plane: a force along the normal has no moment about it.
struct Spread {
  std::vector<int> vertices;   // ascending
  std::vector<double> shares;  // one a vertex, >= 0
};

// Holds buffers, so that spreading allocates nothing once they have grown, and how triangles look
// from the last patch's place, as long as the next one has the same.
class Spreader {
 public:
  explicit Spreader(const geometry::SmoothSurface& surface);

  // From now on spreading allocates nothing.
  void make_room();

  // Every quadrature point is shared by the linear shape functions of the triangle that it meets
  // along the normal. Where one of two opposite points misses the surface, or is beyond a crease or
  // turned away, both are drawn back to the rim. All on the triangle under the centre for a = b =
  // 0.                                                                    docs/theory.md (9)
  void spread(const Patch& patch, Spread& spread);

 private:
  // The weights of a triangle's second and third corner where the perpendicular through a point of
  // the patch's plane, x along its axis and y across (m), meets the triangle's plane.
  struct View {
    unsigned turn = 0;  // which turn of look_from() it is of
    double second = 0.0, second_x = 0.0, second_y = 0.0;
    double third = 0.0, third_x = 0.0, third_y = 0.0;
    bool faces = false;  // it is not turned away
    // Of the quadrature points that meet it: their weights' sum, and those of weight x and weight
    // y.
    double weight = 0.0, weight_x = 0.0, weight_y = 0.0;
  };

  void look_from(const Patch& patch);
  [[nodiscard]] View& view(int triangle) {
    View& seen = views_[static_cast<std::size_t>(triangle)];
    if (seen.turn != turn_) look_at(triangle, seen);
    return seen;
  }
  void look_at(int triangle, View& view) const;
  [[nodiscard]] int triangle_at(double x, double y);
  void share(const geometry::SurfacePoint& point, double weight);

  const geometry::SmoothSurface* surface_;
  std::vector<double> share_;  // one a vertex
  std::vector<int> touched_;   // vertices
  std::vector<int> met_;       // triangles
  Patch from_;                 // whose views are known
  std::vector<View> views_;    // one a triangle
  unsigned turn_ = 0;
};

}  // namespace palpate::contact
