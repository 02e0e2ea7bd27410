// Principal curvatures of a triangulated surface, undeformed or deformed, at and between vertices.
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "base/vec3.h"
#include "geometry/surface.h"

namespace palpate::geometry {

struct Curvature {
  double kappa_1 = 0.0;              // 1/m, the larger one; convex is positive
  double kappa_2 = 0.0;              // 1/m
  Vec3 direction_1 = Vec3::UnitX();  // unit; direction_1 x direction_2 = normal
  Vec3 direction_2 = Vec3::UnitY();
  Vec3 normal = Vec3::UnitZ();  // unit, outward
};

// How well a vertex's neighbours determine its curvature.
enum class StarStatus {
  full,        // neighbours all around
  one_sided,   // cut by a boundary or a crease; enough neighbours remain, first-order accuracy only
  on_crease,   // the vertex belongs to several smooth sides, and no triangle selects one of them
  too_few,     // fewer neighbours than the fit has unknowns, or none
  degenerate,  // neighbours on one or two lines, coincident, or not finite
};
[[nodiscard]] std::string_view explanation(StarStatus status);

struct CurvatureEstimate {
  StarStatus status = StarStatus::too_few;
  Curvature curvature;  // valid if known()
  [[nodiscard]] bool known() const {
    return status == StarStatus::full || status == StarStatus::one_sided;
  }
};

enum class CurvatureMethod {
  quadric,  // quadric through the vertex, fitted to its neighbours: second order
  taubin,   // normal voting, Chen 2007 eq. (6)-(9), with sign: for comparison, does not converge
  taubin_unsigned,  // as printed: with the arccos of eq. (9), concave surfaces become convex
};

struct CurvatureOptions {
  CurvatureMethod method = CurvatureMethod::quadric;
  int rings = 2;  // neighbours up to this number of edges away
  double crease_angle = 40.0 * std::numbers::pi / 180.0;  // rad: sharper edges are creases
};

// Neighbourhoods (stars) for curvature estimates. The neighbours of each vertex are chosen on the
// undeformed surface, so that they stay the same; positions and normals are those of `now`.
class CurvatureStars {
 public:
  CurvatureStars(const Surface& rest, const Neighbours& neighbours,
                 const CurvatureOptions& options = {});

  // The curvature of `now`, which has the triangles of the undeformed surface, at a vertex. For a
  // vertex on a crease, one of its triangles selects the side. Allocates nothing.
  [[nodiscard]] CurvatureEstimate at_vertex(const Surface& now, int vertex,
                                            int triangle = -1) const;

  // The curvatures at the corners of a triangle, on its side of any crease.
  [[nodiscard]] std::array<CurvatureEstimate, 3> at_corners(const Surface& now, int triangle) const;

 private:
  // A side is a vertex with a set of its triangles that are connected without a crease.
  [[nodiscard]] CurvatureEstimate at_side(const Surface& now, int side) const;
  [[nodiscard]] CurvatureEstimate quadric(const Surface& now, int side) const;
  [[nodiscard]] CurvatureEstimate taubin(const Surface& now, int side) const;
  [[nodiscard]] bool plane(const Surface& now, int side) const;   // the vertex and its neighbours
  [[nodiscard]] Vec3 normal(const Surface& now, int side) const;  // not of unit length
  [[nodiscard]] std::span<const int> triangles_of(int side) const;
  [[nodiscard]] std::span<const int> star_of(int side) const;
  [[nodiscard]] const Vec3& position(const Surface& now, int side) const {
    return now.vertices[as_index(vertex_[as_index(side)])];
  }
  [[nodiscard]] StarStatus status_of(int side) const {
    return cut_[as_index(side)] != 0 ? StarStatus::one_sided : StarStatus::full;
  }
  // Root mean square distance of the neighbours, m.
  [[nodiscard]] double spread(const Surface& now, int side) const;
  [[nodiscard]] bool bears_cubic(const Surface& rest, int side) const;
  void part_at_creases(const Surface& rest, const Neighbours& neighbours, double crease_angle);
  void collect_stars(int rings);

  CurvatureMethod method_;
  std::vector<std::array<int, 3>> corners_;       // of each triangle, as sides
  std::vector<int> side_starts_;                  // sides of vertex v: from side_starts_[v]
  std::vector<int> vertex_;                       // of each side
  std::vector<int> triangle_starts_, triangles_;  // of each side, ascending
  std::vector<int> star_starts_, stars_;          // the neighbours of each side, ascending
  std::vector<char> cut_;                         // per side: the star is one-sided
  std::vector<char> cubic_;                       // per side: the star determines cubic terms
};

// The weighted mean of three shape tensors, each rotated by the shortest rotation to the mean
// normal: continuous over the surface, and exact on a sphere.             docs/theory.md [between]
[[nodiscard]] Curvature between(const std::array<Curvature, 3>& corners,
                                const std::array<double, 3>& weights);

// The curvature rotated to another tangent plane by the shortest rotation. `normal` is a unit
// vector and not opposite to the old normal.
[[nodiscard]] Curvature turned_to(const Curvature& curvature, const Vec3& normal);

// The mean of estimates. Corners without an estimate leave their weight to the others, and the
// result is then marked as one_sided; it has no curvature only if no corner has one.
[[nodiscard]] CurvatureEstimate between(const std::array<CurvatureEstimate, 3>& corners,
                                        const std::array<double, 3>& weights);

// The principal curvatures of a symmetric matrix (xx, xy, yy) in the tangent plane of a unit
// normal, with the axes of `tangent_axes`.
[[nodiscard]] Curvature principal(const Vec3& normal, const std::array<double, 3>& matrix);

// Two unit vectors that form a right-handed frame with a unit normal and depend only on it.
[[nodiscard]] std::array<Vec3, 2> tangent_axes(const Vec3& normal);

}  // namespace palpate::geometry
