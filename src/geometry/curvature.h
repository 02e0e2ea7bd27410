// Principal curvatures of a triangulated surface, at rest or deformed: at vertices and between.
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

// kappa_1 t_1 t_1^T + kappa_2 t_2 t_2^T, 1/m.                                docs/theory.md (19)
[[nodiscard]] Eigen::Matrix3d shape_tensor(const Curvature& curvature);

// How well a vertex's neighbours tell its curvature.
enum class StarStatus {
  full,        // neighbours all around
  one_sided,   // cut by a boundary or a crease, but enough is left: first order only
  on_crease,   // the vertex belongs to several smooth sides and no triangle says which is meant
  too_few,     // fewer neighbours than the fit has unknowns, or none
  degenerate,  // neighbours on one or two lines, at one place, or not finite
};
[[nodiscard]] std::string_view explanation(StarStatus status);

struct CurvatureEstimate {
  StarStatus status = StarStatus::too_few;
  Curvature curvature;  // where `known`
  [[nodiscard]] bool known() const {
    return status == StarStatus::full || status == StarStatus::one_sided;
  }
};

enum class CurvatureMethod {
  quadric,  // a quadric through the vertex, fitted to its neighbours: second order
  taubin,   // normal voting, Chen 2007 eq. (6)-(9), signed: for comparison, does not converge
  taubin_unsigned,  // as printed: the arccos of eq. (9) makes hollow surfaces convex
};

struct CurvatureOptions {
  CurvatureMethod method = CurvatureMethod::quadric;
  int rings = 2;                                          // neighbours up to so many edges away
  double crease_angle = 40.0 * std::numbers::pi / 180.0;  // rad: sharper edges part the surface
};

// Who takes part at which vertex is settled on the surface at rest, so that it does not jump while
// the surface moves; positions and normals are those of the surface that is asked about.
class CurvatureStars {
 public:
  CurvatureStars(const Surface& rest, const Neighbours& neighbours,
                 const CurvatureOptions& options = {});

  // The curvature of `now`, which has the triangles of the surface at rest, at a vertex. A vertex
  // on a crease needs one of its triangles to say which side is meant. Does not allocate.
  [[nodiscard]] CurvatureEstimate at_vertex(const Surface& now, int vertex,
                                            int triangle = -1) const;

  // At the corners of a triangle, on its side of any crease.
  [[nodiscard]] std::array<CurvatureEstimate, 3> at_corners(const Surface& now, int triangle) const;

 private:
  // A side is a vertex together with those of its triangles that hang together without a crease.
  [[nodiscard]] CurvatureEstimate at_side(const Surface& now, int side) const;
  [[nodiscard]] CurvatureEstimate quadric(const Surface& now, int side) const;
  [[nodiscard]] CurvatureEstimate taubin(const Surface& now, int side) const;
  [[nodiscard]] Vec3 normal(const Surface& now, int side) const;  // not of unit length
  [[nodiscard]] std::span<const int> triangles_of(int side) const;
  [[nodiscard]] std::span<const int> star_of(int side) const;
  [[nodiscard]] const Vec3& position(const Surface& now, int side) const {
    return now.vertices[static_cast<std::size_t>(vertex_[static_cast<std::size_t>(side)])];
  }
  [[nodiscard]] StarStatus status_of(int side) const {
    return cut_[static_cast<std::size_t>(side)] != 0 ? StarStatus::one_sided : StarStatus::full;
  }
  // The neighbours' root mean square distance, m.
  [[nodiscard]] double spread(const Surface& now, int side) const;
  [[nodiscard]] bool bears_cubic(const Surface& rest, int side) const;
  void part_at_creases(const Surface& rest, const Neighbours& neighbours, double crease_angle);
  void collect_stars(int rings);

  CurvatureMethod method_;
  std::vector<std::array<int, 3>> corners_;       // of each triangle, as sides
  std::vector<int> side_starts_;                  // the sides of vertex v from side_starts_[v]
  std::vector<int> vertex_;                       // of each side
  std::vector<int> triangle_starts_, triangles_;  // of each side, ascending
  std::vector<int> star_starts_, stars_;          // the neighbours of each side, ascending
  std::vector<char> cut_;                         // of each side: is its star one-sided?
  std::vector<char> cubic_;                       // of each side: does its star bear cubic terms?
};

// The mean of three tensors, each turned by the shortest way to the mean normal: continuous as a
// point moves over the surface, exact on a sphere.                            docs/theory.md (22)
[[nodiscard]] Curvature between(const std::array<Curvature, 3>& corners,
                                const std::array<double, 3>& weights);

// The same curvature in another tangent plane, turned there by the shortest way. `normal` is of
// unit length and not opposite to the old one.
[[nodiscard]] Curvature turned_to(const Curvature& curvature, const Vec3& normal);

// The same of estimates: corners that tell nothing leave their part to the others, and the answer
// is then as doubtful as the worst of them; refused only where none tells anything.
[[nodiscard]] CurvatureEstimate between(const std::array<CurvatureEstimate, 3>& corners,
                                        const std::array<double, 3>& weights);

// The symmetric matrix (xx, xy, yy) in the tangent plane of a unit normal, in the axes that
// `tangent_axes` gives, by its principal values.
[[nodiscard]] Curvature principal(const Vec3& normal, const std::array<double, 3>& matrix);

// Two unit vectors that make a right-handed frame with a unit normal; they follow from it alone.
[[nodiscard]] std::array<Vec3, 2> tangent_axes(const Vec3& normal);

}  // namespace palpate::geometry
