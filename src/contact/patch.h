// The patch that a sphere presses on a surface, and its pressure spread over the vertices there.
#pragma once

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

// Shares of a force on the surface's vertices. They sum to 1, and the point of the patch is their
// centre in the tangent plane: a force along the normal has no moment about it.
struct Spread {
  std::vector<int> vertices;   // ascending
  std::vector<double> shares;  // one a vertex, >= 0
};

// Holds buffers, so that spreading allocates nothing once they have grown.
class Spreader {
 public:
  explicit Spreader(const geometry::SmoothSurface& surface);

  // Every quadrature point is shared by the linear shape functions of the triangle that it meets
  // along the normal. Where one of two opposite points misses the surface, or is beyond a crease or
  // turned away, both are drawn back to the rim. All on the triangle under the centre for a = b =
  // 0.                                                                    docs/theory.md (9)
  void spread(const Patch& patch, Spread& spread);

 private:
  [[nodiscard]] bool meets(const Patch& patch, const Vec3& target,
                           geometry::SurfacePoint& met) const;
  void add(const geometry::SurfacePoint& point, double weight);

  const geometry::SmoothSurface* surface_;
  std::vector<double> share_;  // one a vertex
  std::vector<int> touched_;
};

}  // namespace palpate::contact
