// The contact patch of a sphere on a surface, and its pressure distributed over the vertices.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/vec3.h"
#include "contact/point_loads.h"
#include "geometry/smooth_surface.h"

namespace palpate::contact {

// An ellipse in the tangent plane of a surface point, with Hertz's pressure distribution.
struct Patch {
  geometry::SurfacePoint at;
  Vec3 position = Vec3::Zero();   // m
  Vec3 normal = Vec3::UnitZ();    // unit, out of the tissue
  Vec3 axis = Vec3::UnitX();      // unit, tangential, along the semi-axis a
  double a = 0.0, b = 0.0;        // m, semi-axes
  geometry::SurfacePoint beyond;  // as in SmoothSurface::Foot
  double turned = 0.0;

  [[nodiscard]] double radius() const;  // m, of a circle of the same area: sqrt(a b)
};

// Largest number of shares of a patch: three corners for each quadrature point.
inline constexpr std::size_t most_shares = 288;

// Shares of a force on the surface's vertices. They sum to 1, and their centroid in the tangent
// plane is the patch's point, so that a force along the normal has no moment about it.
struct Spread {
  std::vector<int> vertices;   // ascending
  std::vector<double> shares;  // one per vertex, >= 0
};

// Distributes the pressure of patches. Its buffers make spreading free of allocations after the
// first patches; projections of triangles are reused while the next patch has the same position.
class Spreader {
 public:
  explicit Spreader(const geometry::SmoothSurface& surface);

  // After this, spreading allocates nothing in the Spreader.
  void make_room();

  // The weight of every quadrature point is distributed by the linear shape functions of the
  // triangle that it meets along the normal. If the straight way from the centre to one of two
  // opposite points leaves the surface, or comes to a crease or to a triangle turned away, both are
  // moved back to that place. For a = b = 0 the triangle under the centre gets everything.
  // docs/theory.md [shares]
  void spread(const Patch& patch, Spread& spread);

 private:
  // The projection of a triangle: the weights of its second and third corner where the normal
  // through the point (x, y) (m, along and across the axis) meets the triangle's plane.
  struct View {
    unsigned turn = 0;  // the value of turn_ for which it was computed
    double second = 0.0, second_x = 0.0, second_y = 0.0;
    double third = 0.0, third_x = 0.0, third_y = 0.0;
    bool faces = false;  // the triangle is not turned away
    // Over the quadrature points that meet the triangle: the sums of weight, weight x and weight y.
    double weight = 0.0, weight_x = 0.0, weight_y = 0.0;
  };

  void look_from(const Patch& patch);
  [[nodiscard]] View& view(int triangle) {
    View& seen = views_[as_index(triangle)];
    if (seen.turn != turn_) look_at(triangle, seen);
    return seen;
  }
  void look_at(int triangle, View& view) const;
  // A triangle on a straight way from the patch's position, seen along the normal, and the part of
  // the way at which it ends.
  struct Stretch {
    double end = 0.0;
    int triangle = -1;
  };
  // The way to the point (x, y), m, as far as it lies on the surface and crosses no crease: nothing
  // if the patch's own triangle is turned away.
  void follow(double x, double y, std::vector<Stretch>& way);
  void share(const geometry::SurfacePoint& point, double weight);

  const geometry::SmoothSurface* surface_;
  std::vector<double> share_;  // one per vertex
  std::vector<int> touched_;   // vertices
  std::vector<int> met_;       // triangles
  std::vector<Stretch> ahead_, back_;
  Patch from_;               // the patch for which views_ are valid
  std::vector<View> views_;  // one per triangle
  unsigned turn_ = 0;
};

// The displacement and stress of a half-space under a contact patch with Hertz's pressure or the
// friction of its slip.

// Isotropic moduli of the half-space, Pa.
struct HalfSpace {
  double shear_modulus = 0.0;
  double poisson_ratio = 0.0;
};

// At one point, per newton on the patch.
struct FieldValue {
  Vec3 displacement = Vec3::Zero();                  // m/N
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  // Pa/N
};

// The field of an elliptic patch on the plane z = 0 of a half-space z <= 0, whose traction has the
// shape of Hertz's pressure. It is replaced by point loads, the more of them the nearer the point
// is: Boussinesq's along -z, Cerruti's in the plane. Points above the plane count as points on it.
//      K. L. Johnson 1985, eq. (3.18)-(3.19), (3.75)-(3.76); docs/theory.md [split]
class PatchField {
 public:
  // Semi-axes along x and y, m, above 0. The unit vector `along` is the traction's direction: -z,
  // or any in the plane. `finer` multiplies the numbers of point loads.
  PatchField(double a, double b, const HalfSpace& half_space, int finer = 1,
             const Vec3& along = -Vec3::UnitZ());

  [[nodiscard]] FieldValue at(const Vec3& point) const;  // m, from the patch's centre

 private:
  HalfSpace half_space_;
  Vec3 along_;
  double reach_ = 0.0;               // m, the longer semi-axis
  std::array<PointLoads, 3> loads_;  // for far, near and nearest points
};

// Size of the wide patch in semi-axes of the contact, and its least size in spacings of the
// surface. At this size the mesh is finer than its load, and its static compliance is below that of
// the contact, as docs/theory.md [inertia] requires.
inline constexpr double wide_semi_axes = 3.0;
inline constexpr double wide_spacings = 1.5;

// The widened patch about the same point. `axes` are the contact's semi-axes and `spacing` is the
// edge length of the surface's triangles there, all in m.
[[nodiscard]] inline Patch wide_patch(Patch patch, const std::array<double, 2>& axes,
                                      double spacing) {
  patch.a = std::max(wide_semi_axes * axes[0], wide_spacings * spacing);
  patch.b = std::max(wide_semi_axes * axes[1], wide_spacings * spacing);
  return patch;
}

// The typical size of the triangles of a surface.
// The edge length (m) of an equilateral triangle of the mean area, for each part of a surface; a
// part ends at creases.
class SurfaceSpacing {
 public:
  explicit SurfaceSpacing(const geometry::SmoothSurface& surface);

  // The spacing (m) of the patch's part; on a sharp edge between those of both sides.
  [[nodiscard]] double at(const Patch& patch) const;

 private:
  std::vector<int> part_;        // per triangle
  std::vector<double> spacing_;  // per part, m
};

}  // namespace palpate::contact
