// Packs spheres: pushes their centres apart inside the outline until all keep the same distance.
#include "finger/layer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "geometry/shapes.h"

namespace palpate::finger {
namespace {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

// One side of the outline: x n.x + y n.y <= reach inside it.
struct Side {
  Point normal;
  double reach = 0.0;
};

// The outline seen along z: the sides of its convex hull (Andrew's monotone chain), each with its
// mirror image in y, relative to `centre`.
std::vector<Side> outline(const geometry::Surface& surface, const Vec3& centre) {
  std::vector<Point> points;
  for (const Vec3& vertex : surface.vertices)
    points.push_back({vertex.x() - centre.x(), vertex.y() - centre.y()});
  std::ranges::sort(
      points, [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Side> sides;
  for (int half = 0; half < 2; ++half) {
    std::vector<Point> chain;
    for (const Point& next : points) {
      while (chain.size() > 1) {
        const Point& a = chain[chain.size() - 2];
        const Point& b = chain.back();
        if ((b.x - a.x) * (next.y - a.y) - (b.y - a.y) * (next.x - a.x) > 0.0) break;
        chain.pop_back();
      }
      chain.push_back(next);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const double dx = chain[i].x - chain[i - 1].x;
      const double dy = chain[i].y - chain[i - 1].y;
      const double length = std::sqrt(dx * dx + dy * dy);
      if (length == 0.0) continue;
      const Point normal{dy / length, -dx / length};
      const double reach = normal.x * chain[i].x + normal.y * chain[i].y;
      sides.push_back({normal, reach});
      sides.push_back({{normal.x, -normal.y}, reach});
    }
    std::ranges::reverse(points);
  }
  return sides;
}

// Half the outline's extent.
struct Box {
  double along = 0.0;
  double across = 0.0;
};

Box box_of(std::span<const Side> sides) {
  Box box;
  for (const Side& side : sides) {
    box.along = std::max(box.along, side.reach * std::abs(side.normal.x));
    box.across = std::max(box.across, side.reach * std::abs(side.normal.y));
  }
  return box;
}

// Centres relative to the centre of gravity: `middle` points with y = 0, then mirrored pairs.
struct Spread {
  std::vector<Point> points;
  std::size_t middle = 0;
};

double smallest_distance(std::span<const Point> points) {
  double least = std::numeric_limits<double>::infinity();  // squared
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = points[i].x - points[j].x;
      const double dy = points[i].y - points[j].y;
      least = std::min(least, dx * dx + dy * dy);
    }
  return std::sqrt(least);
}

// Pushes points that are nearer than `distance` apart, each by half of the missing distance. A
// point with several neighbours moves by three times the mean, which converges fastest. Returns
// whether any two points were too near.
bool push_apart(std::vector<Point>& points, double distance) {
  struct Push {
    Point sum;
    int near = 0;
  };
  std::vector<Push> pushes(points.size());
  bool pushed = false;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double dx = points[i].x - points[j].x;
      double dy = points[i].y - points[j].y;
      double square = dx * dx + dy * dy;
      if (square >= distance * distance) continue;
      if (square < 1e-6 * distance * distance) {  // coincident: separate along a diagonal
        dx = dy = 1e-3 * distance;
        square = dx * dx + dy * dy;
      }
      const double share = 0.5 * (distance / std::sqrt(square) - 1.0);
      pushes[i].sum.x += share * dx;
      pushes[i].sum.y += share * dy;
      ++pushes[i].near;
      pushes[j].sum.x -= share * dx;
      pushes[j].sum.y -= share * dy;
      ++pushes[j].near;
      pushed = true;
    }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (pushes[i].near == 0) continue;
    points[i].x += 3.0 * pushes[i].sum.x / pushes[i].near;
    points[i].y += 3.0 * pushes[i].sum.y / pushes[i].near;
  }
  return pushed;
}

// Moves every point to at least `inset` inside the outline, then the mean back to the origin.
void hold(Spread& spread, std::span<const Side> sides, double inset) {
  std::vector<Point>& points = spread.points;
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Side& side : sides) {
      const double beyond =
          side.normal.x * points[i].x + side.normal.y * points[i].y - side.reach + inset;
      if (beyond <= 0.0) continue;
      points[i].x -= beyond * side.normal.x;
      points[i].y -= beyond * side.normal.y;
    }
    if (i < spread.middle) points[i].y = 0.0;
    if (i > spread.middle && (i - spread.middle) % 2 != 0)
      points[i] = {points[i - 1].x, -points[i - 1].y};
    sum += points[i].x;
  }
  const double mean = sum / static_cast<double>(points.size());
  for (Point& point : points) point.x -= mean;
}

double fraction(double value) { return value - std::floor(value); }

// Distributes points evenly over the outline's box by the sequence of multiples of powers of the
// plastic number (M. Roberts 2018); `start` selects a section of the sequence.
Spread strewn(const Box& box, int count, int middle, int start) {
  const auto [along, across] = box;
  Spread spread;
  spread.middle = as_index(middle);
  for (int i = 0; i < middle; ++i)
    spread.points.push_back({along * ((2.0 * i + 1.0) / middle - 1.0), 0.0});
  for (int i = 0; 2 * i < count - middle; ++i) {
    const int k = i + 1 + 100 * start;
    const double x = along * (2.0 * fraction(k * 0.7548776662466927) - 1.0);
    const double y = across * fraction(k * 0.5698402909980532);
    spread.points.push_back({x, y});
    spread.points.push_back({x, -y});
  }
  return spread;
}

// Starts with a distance that is slightly too large and reduces it until all points keep it.
void relax(Spread& spread, std::span<const Side> sides, const Box& box, double inset) {
  // Discs of diameter d in hexagonal order cover sqrt(3)/2 d^2 each and extend d/2 beyond their
  // centres: n sqrt(3)/2 d^2 = (2 p + d) (2 q + d), minus the corners.
  const double p = std::max(box.along - inset, 0.0);
  const double q = std::max(box.across - inset, 0.0);
  const double a =
      std::sqrt(3.0) / 2.0 * static_cast<double>(spread.points.size()) - std::numbers::pi / 4.0;
  double distance = 1.1 * (p + q + std::sqrt((p + q) * (p + q) + 4.0 * a * p * q)) / a;
  for (int i = 0; i < 10; ++i) hold(spread, sides, inset);
  constexpr int most_sweeps = 3000;  // 0.998^3000 of the distance is practically zero
  for (int sweep = 0; sweep < most_sweeps && push_apart(spread.points, distance); ++sweep) {
    for (int i = 0; i < 3; ++i) hold(spread, sides, inset);
    distance *= 0.998;
  }
}

// The best of several starts for each number of points on the mirror line, up to a full row.
std::vector<Point> spread_out(std::span<const Side> sides, double inset, int count) {
  const Box box = box_of(sides);
  const double row = 1.0 + 1.3 * std::sqrt(count * box.along / box.across);
  std::vector<Point> best;
  double widest = -1.0;
  for (int middle = count % 2; middle <= std::min(count, static_cast<int>(row)); middle += 2) {
    for (int start = 0; start < 4; ++start) {
      Spread spread = strewn(box, count, middle, start);
      relax(spread, sides, box, inset);
      const double distance = smallest_distance(spread.points);
      if (distance <= widest) continue;
      widest = distance;
      best = std::move(spread.points);
    }
  }
  return best;
}

}  // namespace

double Layer::mass() const {
  return static_cast<double>(centres.size()) * density * 4.0 / 3.0 * std::numbers::pi * radius *
         radius * radius;
}

Layer pack(const geometry::Surface& fingertip, double density, int count) {
  assert(count >= 1 && count <= most_spheres);
  const geometry::Enclosed inside = geometry::enclosed(geometry::with_closed_base(fingertip));
  // m_i = M/n = rho 4/3 pi r^3                  Chen 2007 eq. (5); docs/theory.md [spheres]
  const double radius = std::cbrt(0.75 * inside.volume / (std::numbers::pi * count));
  Layer layer{radius, density, {}};
  for (const Point& point : spread_out(outline(fingertip, inside.centroid), radius, count))
    layer.centres.emplace_back(point.x, point.y, 0.0);
  return layer;
}

double modulus_factor(Calibration calibration, int count) {
  // n (r/n^(1/3))^(1/2) = n^(5/6) r^(1/2)               docs/theory.md [calibration]
  return calibration == Calibration::force ? std::pow(count, -5.0 / 6.0) : 1.0;
}

}  // namespace palpate::finger
