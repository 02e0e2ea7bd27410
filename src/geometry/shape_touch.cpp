// Sweeps: the highest of the circles that the sphere's sections and the body's sections allow.
#include "geometry/shape_touch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numerics.h"

namespace palpate::geometry {
namespace {

// A section with its derivatives with respect to y, by central differences: the sections of all
// shapes are polynomials of at most fourth degree, so that 1e-3 of the length is exact to 1e-5.
struct Slopes {
  Section at, first, second;  // m, 1, 1/m

  Slopes(const Sweep& sweep, double y) {
    const auto& section = sweep.sections.front();
    const double step = 1e-3 * sweep.length;
    const Section before = section(y - step);
    const Section after = section(y + step);
    at = section(y);
    const auto differences = [&](double Section::*of) {
      first.*of = (after.*of - before.*of) / (2.0 * step);
      second.*of = ((after.*of - at.*of) - (at.*of - before.*of)) / (step * step);
    };
    differences(&Section::straight);
    differences(&Section::radius);
  }
};

ShapeTouch on_edge() {
  ShapeTouch touch;
  touch.on_edge = true;
  return touch;
}

// A sphere above a sweep, in planes normal to y.
struct Lowered {
  const Sweep& sweep;
  double x, y, radius;

  // The radius of the sphere's section, m.
  [[nodiscard]] double circle(double at) const {
    return std::sqrt(std::max(0.0, radius * radius - (at - y) * (at - y)));
  }
  // How far the centre is beside the straight part of a section, m.
  [[nodiscard]] double beside(const Section& section) const {
    return std::max(0.0, std::abs(x - sweep.x) - section.straight);
  }
  // The height (m) of the centre above the sweep's axis if the sections at `at` touch each other.
  [[nodiscard]] double height(double at) const {
    const Section section = sweep.sections.front()(at);
    const double reach = section.radius + circle(at);
    const double d = beside(section);
    return d > reach ? -std::numeric_limits<double>::infinity() : std::sqrt(reach * reach - d * d);
  }
  // Its derivative, times a positive number.
  [[nodiscard]] double slope(double at) const {
    const Slopes section(sweep, at);
    const double own = circle(at);
    const double fall = own > 0.0 ? (at - y) / own : (at > y ? 1.0 : -1.0) * HUGE_VAL;
    return (section.at.radius + own) * (section.first.radius - fall) +
           beside(section.at) * section.first.straight;
  }
};

// f = |(d, z)| - r with d = |x - x_0| - s beside the straight part, else f = z - r.
//                                                                  docs/theory.md [from_above]
ShapeTouch on_side(const Lowered& sphere, double at) {
  const Sweep& sweep = sphere.sweep;
  const Slopes section(sweep, at);
  const double side = sphere.x < sweep.x ? -1.0 : 1.0;
  const double d = sphere.beside(section.at);
  const double cosine = d / (section.at.radius + sphere.circle(at));
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double r_1 = section.first.radius;
  const double s_1 = section.first.straight;
  const Vec3 gradient(side * cosine, -(r_1 + s_1 * cosine), sine);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  second(1, 1) = -section.second.radius - cosine * section.second.straight;
  const bool round = d > 0.0 || section.at.straight == 0.0;
  if (round) {
    const Vec3 around(side * sine, -s_1 * sine, -cosine);
    second += around * around.transpose() / section.at.radius;
  }
  ShapeTouch touch;
  touch.position = {
      d > 0.0 ? sweep.x + side * (section.at.straight + section.at.radius * cosine) : sphere.x, at,
      sweep.z + section.at.radius * sine};
  touch.curvature = level_curvature(gradient, second);
  return touch;
}

std::optional<ShapeTouch> touch_sweep(const Sweep& sweep, double x, double y, double radius) {
  const Lowered sphere{sweep, x, y, radius};
  const double from = std::max(0.0, y - radius);
  const double to = std::min(sweep.length, y + radius);
  if (!(from <= to)) return std::nullopt;
  // The heights may have several maxima on a body that is hollow along its axis.
  constexpr int pieces = 400;
  const auto place = [&](int i) { return i < pieces ? from + (to - from) * i / pieces : to; };
  int best = 0;
  for (int i = 1; i <= pieces; ++i)
    if (sphere.height(place(i)) > sphere.height(place(best))) best = i;
  if (!std::isfinite(sphere.height(place(best)))) return std::nullopt;
  const double low = place(std::max(best - 1, 0));
  const double high = place(std::min(best + 1, pieces));
  if ((low == 0.0 && !(sphere.slope(low) > 0.0)) ||
      (high == sweep.length && !(sphere.slope(high) < 0.0)))
    return on_edge();
  const auto rises = [&](double at) { return sphere.slope(at) > 0.0; };
  return on_side(sphere, numerics::change({low, high}, 0.0, rises).low);
}

// The centre is at p + t p / a^2 (per axis) for the point p; t grows with the radius.
std::optional<ShapeTouch> touch_ellipsoid(const Ellipsoid& ellipsoid, double x, double y,
                                          double radius) {
  const Vec3 half = 0.5 * ellipsoid.size;
  const Vec3 squares = half.cwiseProduct(half);
  const Vec3 away = Vec3(x, y, 0.0) - Vec3(half.x(), half.y(), 0.0);
  const auto point = [&](double t) {
    Vec3 p = away.cwiseProduct(squares).cwiseQuotient(squares + Vec3::Constant(t));
    const double rest = 1.0 - p.x() * p.x() / squares.x() - p.y() * p.y() / squares.y();
    p.z() = rest >= 0.0 ? half.z() * std::sqrt(rest) : -1.0;
    return p;
  };
  const auto too_near = [&](double t) {
    const Vec3 p = point(t);
    return p.z() < 0.0 || t * p.cwiseQuotient(squares).norm() < radius;
  };
  double far = 2.0 * radius * half.maxCoeff();  // |p / a^2| is at least 1 / max(a)
  if (too_near(far)) return std::nullopt;
  far = numerics::change({0.0, far}, 0.0, too_near).high;
  const Vec3 p = point(far);
  // Beside the ellipsoid the search ends where the point reaches the widest section.
  if (far * p.cwiseQuotient(squares).norm() > radius * (1.0 + 1e-9)) return std::nullopt;
  return ShapeTouch{
      .position = half + p,
      .curvature = level_curvature(p.cwiseQuotient(squares), squares.cwiseInverse().asDiagonal())};
}

}  // namespace

Curvature level_curvature(const Vec3& gradient, const Eigen::Matrix3d& second) {
  const double length = gradient.norm();
  const Vec3 normal = gradient / length;
  const auto [a, b] = tangent_axes(normal);
  return principal(
      normal, {a.dot(second * a) / length, a.dot(second * b) / length, b.dot(second * b) / length});
}

std::optional<ShapeTouch> touch_from_above(const Shape& shape, double x, double y, double radius) {
  if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape))
    return touch_ellipsoid(*ellipsoid, x, y, radius);
  if (const auto sweep = outer_sweep(shape)) return touch_sweep(*sweep, x, y, radius);
  const Vec3 size = extent(shape);  // of a cuboid
  const double past_x = std::max({0.0, -x, x - size.x()});
  const double past_y = std::max({0.0, -y, y - size.y()});
  if (std::hypot(past_x, past_y) >= radius) return std::nullopt;
  if (past_x > 0.0 || past_y > 0.0) return on_edge();
  ShapeTouch touch;
  touch.position = {x, y, size.z()};
  return touch;
}

}  // namespace palpate::geometry
