// Computes principal curvatures in a tangent plane, and curvatures between vertices.
#include "geometry/curvature.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace palpate::geometry {
CurvatureStars::CurvatureStars(const Surface& rest, const Neighbours& neighbours,
                               const CurvatureOptions& options)
    : method_(options.method), corners_(rest.triangles.size(), {-1, -1, -1}) {
  part_at_creases(rest, neighbours, options.crease_angle);
  collect_stars(options.rings);
  for (std::size_t s = 0; s < vertex_.size(); ++s)
    cubic_.push_back(bears_cubic(rest, static_cast<int>(s)) ? 1 : 0);
}

void CurvatureStars::part_at_creases(const Surface& rest, const Neighbours& neighbours,
                                     double crease_angle) {
  const auto joined = [&](int triangle, int other) {
    return other >= 0 &&
           angle_between(twice_area(rest, triangle), twice_area(rest, other)) <= crease_angle;
  };
  std::vector<int> waiting;
  triangle_starts_.push_back(0);
  for (std::size_t v = 0; v < rest.vertices.size(); ++v) {
    const int vertex = static_cast<int>(v);
    side_starts_.push_back(static_cast<int>(vertex_.size()));
    for (const int start : neighbours.triangles_at(vertex)) {
      const auto corner = [&](int triangle) -> int& {
        const auto t = as_index(triangle);
        return corners_[t][corner_of(rest.triangles[t], vertex)];
      };
      if (corner(start) >= 0) continue;
      const int side = static_cast<int>(vertex_.size());
      vertex_.push_back(vertex);
      corner(start) = side;
      waiting.assign(1, start);
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        const int triangle = waiting[i];
        const std::size_t at = corner_of(rest.triangles[as_index(triangle)], vertex);
        // The two edges of the triangle that meet at the vertex.
        for (const std::size_t edge : {at, (at + 2) % 3}) {
          const int other = neighbours.across(triangle)[edge];
          if (!joined(triangle, other) || corner(other) >= 0) continue;
          corner(other) = side;
          waiting.push_back(other);
        }
      }
      std::ranges::sort(waiting);
      triangles_.insert(triangles_.end(), waiting.begin(), waiting.end());
      triangle_starts_.push_back(static_cast<int>(triangles_.size()));
    }
  }
  side_starts_.push_back(static_cast<int>(vertex_.size()));
}

void CurvatureStars::collect_stars(int rings) {
  // A copy of the surface that is cut along its creases, which thereby become boundaries.
  Surface parted;
  parted.vertices.resize(vertex_.size());
  parted.triangles = corners_;
  const Neighbours neighbours(parted);
  std::vector<int> seen_from(vertex_.size(), -1);
  star_starts_.push_back(0);
  for (std::size_t s = 0; s < vertex_.size(); ++s) {
    const int side = static_cast<int>(s);
    const std::size_t start = stars_.size();
    seen_from[s] = side;
    bool cut = false;
    const auto look_around = [&](int from) {
      cut = cut || neighbours.on_boundary(from);
      for (const int next : neighbours.vertices_at(from)) {
        if (seen_from[as_index(next)] == side) continue;
        seen_from[as_index(next)] = side;
        stars_.push_back(next);
      }
    };
    look_around(side);
    std::size_t first = start;
    for (int ring = 1; ring < rings; ++ring) {
      const std::size_t last = stars_.size();
      for (; first < last; ++first) look_around(stars_[first]);
    }
    std::sort(stars_.begin() + static_cast<std::ptrdiff_t>(start), stars_.end());
    star_starts_.push_back(static_cast<int>(stars_.size()));
    cut_.push_back(cut ? 1 : 0);
  }
}

std::span<const int> CurvatureStars::triangles_of(int side) const {
  return list_of(triangle_starts_, triangles_, side);
}

std::span<const int> CurvatureStars::star_of(int side) const {
  return list_of(star_starts_, stars_, side);
}

double CurvatureStars::spread(const Surface& now, int side) const {
  double squares = 0.0;
  for (const int other : star_of(side))
    squares += (position(now, other) - position(now, side)).squaredNorm();
  return std::sqrt(squares / static_cast<double>(star_of(side).size()));
}

Vec3 CurvatureStars::normal(const Surface& now, int side) const {
  Vec3 sum = Vec3::Zero();
  for (const int triangle : triangles_of(side)) sum += twice_area(now, triangle);
  return sum;
}

std::string_view explanation(StarStatus status) {
  switch (status) {
    case StarStatus::full: return "neighbours all around";
    case StarStatus::one_sided:
      return "a boundary or a sharp edge cuts the neighbours off on one side";
    case StarStatus::on_crease:
      return "the vertex lies on a sharp edge; say by a triangle which side is meant";
    case StarStatus::too_few: return "too few neighbours; refine the surface or take more rings";
    case StarStatus::degenerate:
      return "the vertices around lie on one or two lines, as those of long strips do; divide long "
             "triangles across";
  }
  return "";
}

std::array<Vec3, 2> tangent_axes(const Vec3& normal) {
  // The coordinate axis with the largest angle to the normal; the first of equal ones.
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(normal[i]) < std::abs(normal[axis])) axis = i;
  const Vec3 first = (Vec3::Unit(axis) - normal[axis] * normal).normalized();
  return {first, normal.cross(first)};
}

Curvature principal(const Vec3& normal, const std::array<double, 3>& matrix) {
  const auto [axis_x, axis_y] = tangent_axes(normal);
  const auto [xx, xy, yy] = matrix;
  const double mean = 0.5 * (xx + yy);
  const double half = 0.5 * (xx - yy);
  const double radius = std::sqrt(half * half + xy * xy);
  // The eigenvector of the eigenvalue mean + radius, in the form without cancellation.
  double x = half >= 0.0 ? half + radius : xy;
  double y = half >= 0.0 ? xy : radius - half;
  const double length = std::sqrt(x * x + y * y);
  x = length > 0.0 ? x / length : 1.0;
  y = length > 0.0 ? y / length : 0.0;
  return {.kappa_1 = mean + radius,
          .kappa_2 = mean - radius,
          .direction_1 = x * axis_x + y * axis_y,
          .direction_2 = x * axis_y - y * axis_x,
          .normal = normal};
}

Curvature turned_to(const Curvature& curvature, const Vec3& normal) {
  // A tangent t at n becomes t - (n' . t) (n + n') / (1 + n . n') at n'.  docs/theory.md [between]
  const Vec3 middle = (normal + curvature.normal) / (1.0 + normal.dot(curvature.normal));
  Curvature turned = curvature;
  turned.normal = normal;
  turned.direction_1 -= normal.dot(curvature.direction_1) * middle;
  turned.direction_2 -= normal.dot(curvature.direction_2) * middle;
  return turned;
}

Curvature between(const std::array<Curvature, 3>& corners, const std::array<double, 3>& weights) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) normal += weights[i] * corners[i].normal;
  normal.normalize();
  const std::array<Vec3, 2> axes = tangent_axes(normal);
  std::array<double, 3> matrix{};
  const auto add = [&](double kappa, const Vec3& direction) {
    const double x = direction.dot(axes[0]);
    const double y = direction.dot(axes[1]);
    matrix[0] += kappa * x * x;
    matrix[1] += kappa * x * y;
    matrix[2] += kappa * y * y;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Curvature corner = turned_to(corners[i], normal);
    add(weights[i] * corner.kappa_1, corner.direction_1);
    add(weights[i] * corner.kappa_2, corner.direction_2);
  }
  return principal(normal, matrix);
}

CurvatureEstimate CurvatureStars::at_vertex(const Surface& now, int vertex, int triangle) const {
  const int first = side_starts_[as_index(vertex)];
  const int last = side_starts_[as_index(vertex) + 1];
  if (first == last) return {};
  if (triangle >= 0) {
    for (const int side : corners_[as_index(triangle)])
      if (vertex_[as_index(side)] == vertex) return at_side(now, side);
  }
  if (last - first > 1) return {.status = StarStatus::on_crease, .curvature = {}};
  return at_side(now, first);
}

std::array<CurvatureEstimate, 3> CurvatureStars::at_corners(const Surface& now,
                                                            int triangle) const {
  std::array<CurvatureEstimate, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = at_side(now, corners_[as_index(triangle)][i]);
  return corners;
}

CurvatureEstimate between(const std::array<CurvatureEstimate, 3>& corners,
                          const std::array<double, 3>& weights) {
  CurvatureEstimate all{.status = StarStatus::full, .curvature = {}};
  const Curvature* known = nullptr;
  for (const CurvatureEstimate& corner : corners) {
    if (corner.status != StarStatus::full) all.status = corner.status;
    if (corner.known()) known = &corner.curvature;
  }
  if (known == nullptr) return all;
  if (all.status != StarStatus::full) all.status = StarStatus::one_sided;
  std::array<Curvature, 3> curvatures;
  std::array<double, 3> left{};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    curvatures[i] = corners[i].known() ? corners[i].curvature : *known;
    left[i] = corners[i].known() ? weights[i] : 0.0;
    sum += left[i];
  }
  // All weight is on corners without an estimate; the others are then used with equal weights.
  if (sum <= 0.0) left = {1.0, 1.0, 1.0};
  for (double& weight : left) weight /= sum > 0.0 ? sum : 3.0;
  all.curvature = between(curvatures, left);
  return all;
}

CurvatureEstimate CurvatureStars::at_side(const Surface& now, int side) const {
  CurvatureEstimate found =
      method_ == CurvatureMethod::quadric ? quadric(now, side) : taubin(now, side);
  // Of a plane any number of neighbours tells the curvature.
  if (!found.known() && plane(now, side))
    found = {.status = StarStatus::full,
             .curvature = principal(normal(now, side).normalized(), {0.0, 0.0, 0.0})};
  return found;
}

bool CurvatureStars::plane(const Surface& now, int side) const {
  constexpr double rounding = 1e-5;  // of files
  const std::span<const int> star = star_of(side);
  const Vec3 upright = normal(now, side).normalized();
  const double off = rounding * spread(now, side);
  return star.size() > 1 && std::ranges::all_of(star, [&](int other) {
           const Vec3 away = position(now, other) - position(now, side);
           return away.norm() > off && std::abs(upright.dot(away)) <= off;
         });
}

namespace {

// A pivot below this fraction of its diagonal entry counts as zero: it would amplify the
// neighbours' errors more than a hundredfold. Cubic terms only add accuracy: their limit is
// stricter.
constexpr double smallest_pivot = 1e-4;
constexpr double smallest_cubic_pivot = 3e-3;

// Least squares with n unknowns by normal equations.                     docs/theory.md [quadric]
template <std::size_t n>
class Fit {
 public:
  void add(const std::array<double, n>& row, double value, double weight) {
    for (std::size_t i = 0; i < n; ++i) {
      const double weighted = weight * row[i];
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weighted * row[j];
      right_[i] += weighted * value;
    }
  }

  // Solves by L D L^T. Empty if a pivot is too small or not a number.
  std::optional<std::array<double, n>> solve(double least_pivot) {
    std::array<double, n> inverse{};  // of D
    for (std::size_t j = 0; j < n; ++j) {
      double pivot = matrix_[j][j];
      for (std::size_t k = 0; k < j; ++k) {
        const double scaled = matrix_[j][k];  // rows contain L D until they are processed, then L
        matrix_[j][k] *= inverse[k];
        pivot -= matrix_[j][k] * scaled;
      }
      if (!(pivot > least_pivot * matrix_[j][j])) return std::nullopt;
      inverse[j] = 1.0 / pivot;
      for (std::size_t i = j + 1; i < n; ++i)
        for (std::size_t k = 0; k < j; ++k) matrix_[i][j] -= matrix_[i][k] * matrix_[j][k];
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < i; ++k) right_[i] -= matrix_[i][k] * right_[k];
    for (std::size_t i = 0; i < n; ++i) right_[i] *= inverse[i];
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t k = i + 1; k < n; ++k) right_[i] -= matrix_[k][i] * right_[k];
    return right_;
  }

 private:
  std::array<std::array<double, n>, n> matrix_{};  // the lower triangle
  std::array<double, n> right_{};
};

template <std::size_t n>
std::array<double, n> terms(double x, double y) {
  if constexpr (n == 5)
    return {x, y, 0.5 * x * x, x * y, 0.5 * y * y};
  else
    return {x, y, 0.5 * x * x, x * y, 0.5 * y * y, x * x * x, x * x * y, x * y * y, y * y * y};
}

// The coefficients of `terms` with lengths in units of `length`. `offset(i)` is neighbour i's
// position relative to the vertex, m.
template <std::size_t n, class Offset>
std::optional<std::array<double, n>> fit(std::size_t count, const Offset& offset,
                                         const Vec3& normal, double length, double least_pivot) {
  const auto [axis_x, axis_y] = tangent_axes(normal);
  const double shrink = 1.0 / length;
  Fit<n> fit;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 d = shrink * offset(i);
    const double x = d.dot(axis_x);
    const double y = d.dot(axis_y);
    const double z = d.dot(normal);
    // The circle that touches the plane at the vertex and passes through the neighbour has the
    // radius (r^2 + z^2) / (2 z). z r^2/(r^2 + z^2) is the height of the parabola with this
    // curvature; with it the fit is exact on a sphere, where z itself has terms of fourth order.
    // Near neighbours weigh more: there, omitted terms are smaller.
    // docs/theory.md [quadric]
    const double square = x * x + y * y;
    const double distance = square + z * z;
    fit.add(terms<n>(x, y), z * square / distance, 1.0 / distance);
  }
  return fit.solve(least_pivot);
}

// The unit normal of a plane with the slopes `x` and `y` along the axes of `normal`.
Vec3 tilted(const Vec3& normal, double x, double y) {
  const auto [axis_x, axis_y] = tangent_axes(normal);
  return (normal - x * axis_x - y * axis_y).normalized();
}

}  // namespace

bool CurvatureStars::bears_cubic(const Surface& rest, int side) const {
  const std::span<const int> star = star_of(side);
  const Vec3& origin = position(rest, side);
  const auto offset = [&](std::size_t i) -> Vec3 { return position(rest, star[i]) - origin; };
  const Vec3 direction = normal(rest, side);
  return star.size() >= 9 && fit<9>(star.size(), offset, direction.normalized(), spread(rest, side),
                                    smallest_cubic_pivot)
                                 .has_value();
}

CurvatureEstimate CurvatureStars::quadric(const Surface& now, int side) const {
  const std::span<const int> star = star_of(side);
  if (star.size() < 5) return {.status = StarStatus::too_few, .curvature = {}};
  const Vec3& origin = position(now, side);
  const auto offset = [&](std::size_t i) -> Vec3 { return position(now, star[i]) - origin; };
  CurvatureEstimate degenerate{.status = StarStatus::degenerate, .curvature = {}};
  const double length = spread(now, side);
  // A first fit with the triangles' normal gives the slope, and with it the normal for the second.
  Vec3 normal = this->normal(now, side).normalized();
  const auto slope = fit<5>(star.size(), offset, normal, length, smallest_pivot);
  if (!slope) return degenerate;
  normal = tilted(normal, (*slope)[0], (*slope)[1]);
  // The height is positive outwards, so that a convex surface curves down. The remaining slope is
  // small enough for the formula without slope; it only corrects the normal.
  const auto answer = [&](double x, double y, const std::array<double, 3>& second) {
    const std::array<double, 3> matrix{-second[0] / length, -second[1] / length,
                                       -second[2] / length};
    return CurvatureEstimate{
        .status = status_of(side),
        .curvature = turned_to(principal(normal, matrix), tilted(normal, x, y))};
  };
  if (cubic_[as_index(side)] != 0) {
    const auto c = fit<9>(star.size(), offset, normal, length, smallest_pivot);
    return c ? answer((*c)[0], (*c)[1], {(*c)[2], (*c)[3], (*c)[4]}) : degenerate;
  }
  const auto c = fit<5>(star.size(), offset, normal, length, smallest_pivot);
  return c ? answer((*c)[0], (*c)[1], {(*c)[2], (*c)[3], (*c)[4]}) : degenerate;
}

CurvatureEstimate CurvatureStars::taubin(const Surface& now, int side) const {
  const Vec3& origin = position(now, side);
  const Vec3 normal = this->normal(now, side).normalized();
  const auto [axis_x, axis_y] = tangent_axes(normal);
  std::array<double, 3> vote{};
  double weights = 0.0;
  for (const int other : star_of(side)) {
    const Vec3 d = position(now, other) - origin;
    const Vec3 tangent = (d - normal.dot(d) * normal).normalized();
    // n_i is the neighbour's normal in the plane of N_p and T_i. Its angle from N_p towards T_i is
    // positive where the surface is convex; the paper's arccos is always positive.
    const Vec3 other_normal = this->normal(now, other);
    double angle = std::atan2(other_normal.dot(tangent), other_normal.dot(normal));
    if (method_ == CurvatureMethod::taubin_unsigned) angle = std::abs(angle);
    // Arc length divided by chord; exact on a sphere.
    const double half = 0.5 * angle;
    const double arc = d.norm() * (half != 0.0 ? half / std::sin(half) : 1.0);
    const double kappa = angle / arc;
    double weight = 0.0;
    for (const int triangle : triangles_of(other)) weight += twice_area(now, triangle).norm();
    const double x = tangent.dot(axis_x);
    const double y = tangent.dot(axis_y);
    vote[0] += weight * kappa * x * x;
    vote[1] += weight * kappa * x * y;
    vote[2] += weight * kappa * y * y;
    weights += weight;
  }
  if (star_of(side).size() < 3) return {.status = StarStatus::too_few, .curvature = {}};
  if (!(weights > 0.0) || !std::isfinite(vote[0] + vote[1] + vote[2]))
    return {.status = StarStatus::degenerate, .curvature = {}};
  // k_1 = 3 m_1 - m_2 and k_2 = 3 m_2 - m_1: the matrix 4 M - trace(M) I.  docs/theory.md [taubin]
  const double trace = vote[0] + vote[2];
  const double scale = 1.0 / weights;
  return {.status = status_of(side),
          .curvature = principal(normal, {scale * (4.0 * vote[0] - trace), scale * 4.0 * vote[1],
                                          scale * (4.0 * vote[2] - trace)})};
}

}  // namespace palpate::geometry
