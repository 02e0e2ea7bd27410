// Quadrature of the Hertz pressure in polar coordinates.
#include "contact/flat_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace palpate::contact {
namespace {

constexpr int rings = 6;
constexpr int spokes = 16;

struct Point {
  double x, y;    // in contact radii
  double weight;  // the 96 sum to 1
};

// With s = sqrt(1 - r^2/a^2) the pressure's share p r dr becomes s^2 ds on [0, 1]: Gauss-Legendre
// in s, equal angles around. 6-point abscissae: Abramowitz & Stegun 1964, table 25.4.
std::array<Point, static_cast<std::size_t>(rings* spokes)> make_points() {
  constexpr std::array abscissae{0.238619186083196909, 0.661209386466264514, 0.932469514203152028};
  constexpr std::array weights{0.467913934572691047, 0.360761573048138608, 0.171324492379170345};
  std::array<Point, static_cast<std::size_t>(rings * spokes)> points{};
  std::size_t next = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t i = static_cast<std::size_t>(ring) / 2;
    const double s = 0.5 + (ring % 2 == 0 ? -0.5 : 0.5) * abscissae[i];
    const double r = std::sqrt(1.0 - s * s);
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double angle = 2.0 * std::numbers::pi * (spoke + 0.5) / spokes;
      points[next++] = {r * std::cos(angle), r * std::sin(angle),
                        3.0 * s * s * 0.5 * weights[i] / spokes};
    }
  }
  return points;
}

}  // namespace

Spread spread_over_flat(const geometry::FlatTop& top, const Vec3& centre, double radius) {
  static const auto points = make_points();
  std::map<int, double> share;
  for (const Point& point : points) {
    const double x = centre.x() + radius * point.x;
    const double y = centre.y() + radius * point.y;
    auto place = top.locate(x, y);
    // Beyond the edge: back towards the centre in eighths, so that no share is lost.
    for (int back = 1; !place && back <= 8; ++back) {
      const double left = 1.0 - 0.125 * back;
      place =
          top.locate(centre.x() + left * radius * point.x, centre.y() + left * radius * point.y);
    }
    if (!place) continue;  // the centre itself is off the face: no contact there
    for (std::size_t k = 0; k < 3; ++k)
      if (place->weights[k] > 0.0) share[place->nodes[k]] += point.weight * place->weights[k];
  }
  Spread spread;
  for (const auto& [node, value] : share) {
    spread.nodes.push_back(node);
    spread.shares.push_back(value);
  }
  return spread;
}

}  // namespace palpate::contact
