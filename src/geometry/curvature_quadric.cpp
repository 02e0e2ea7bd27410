// Computes curvature from a quadric through the vertex, fitted to its neighbours by least squares.
#include <cmath>
#include <optional>

#include "geometry/curvature.h"

namespace palpate::geometry {
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

}  // namespace palpate::geometry
