// Quadrature of the Hertz pressure in polar coordinates, and a walk over the triangles.
#include "contact/patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate::contact {
namespace {

constexpr int rings = 6;
constexpr int half_spokes = 8;

// A quadrature point and its opposite, in semi-axes.
struct Pair {
  double x, y;
  double weight;  // of each of the two; all together sum to 1
};
using Pairs = std::array<Pair, static_cast<std::size_t>(rings* half_spokes)>;

// With s = sqrt(1 - r^2/a^2) the pressure's share p r dr becomes s^2 ds on [0, 1]: Gauss-Legendre
// in s, equal angles around. 6-point abscissae: Abramowitz & Stegun 1964, table 25.4.
Pairs make_pairs() {
  constexpr std::array abscissae{0.238619186083196909, 0.661209386466264514, 0.932469514203152028};
  constexpr std::array weights{0.467913934572691047, 0.360761573048138608, 0.171324492379170345};
  Pairs pairs{};
  std::size_t next = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t i = static_cast<std::size_t>(ring) / 2;
    const double s = 0.5 + (ring % 2 == 0 ? -0.5 : 0.5) * abscissae[i];
    const double r = std::sqrt(1.0 - s * s);
    for (int spoke = 0; spoke < half_spokes; ++spoke) {
      const double angle = std::numbers::pi * (spoke + 0.5) / half_spokes;
      pairs[next++] = {r * std::cos(angle), r * std::sin(angle),
                       3.0 * s * s * 0.5 * weights[i] / (2 * half_spokes)};
    }
  }
  return pairs;
}

constexpr double least_facing = 0.2;  // cosine: a triangle turned further away is not pressed

}  // namespace

double Patch::radius() const { return std::sqrt(a * b); }

Spreader::Spreader(const geometry::SmoothSurface& surface)
    : surface_(&surface), share_(surface.surface().vertices.size(), 0.0) {}

// Walks from the patch's triangle to the one that holds `target`, seen along the normal.
bool Spreader::meets(const Patch& patch, const Vec3& target, geometry::SurfacePoint& met) const {
  constexpr int most_steps = 1000;
  const geometry::Surface& surface = surface_->surface();
  int triangle = patch.at.triangle;
  for (int step = 0; step < most_steps; ++step) {
    const auto& [i, j, k] = surface.triangles[static_cast<std::size_t>(triangle)];
    const Vec3& corner = surface.vertices[static_cast<std::size_t>(i)];
    const Vec3 side_b = surface.vertices[static_cast<std::size_t>(j)] - corner;
    const Vec3 side_c = surface.vertices[static_cast<std::size_t>(k)] - corner;
    const Vec3 upright = side_b.cross(side_c);
    const double seen = upright.dot(patch.normal);
    if (seen < least_facing * upright.norm()) return false;
    const Vec3 away = target - corner;
    Vec3 weights;
    weights[1] = patch.normal.dot(away.cross(side_c)) / seen;
    weights[2] = patch.normal.dot(side_b.cross(away)) / seen;
    weights[0] = 1.0 - weights[1] - weights[2];
    Eigen::Index least = 0;
    const double lowest = weights.minCoeff(&least);
    constexpr double rounding = 1e-12;
    const int next =
        surface_->neighbours().across(triangle)[static_cast<std::size_t>(least + 1) % 3];
    if (lowest >= -rounding || (next < 0 && lowest >= -1e-9)) {
      met = {triangle, weights};
      return true;
    }
    // Crossing a crease would load the side beyond at once, as soon as it faces the patch.
    if (surface_->crease(triangle, static_cast<std::size_t>(least + 1) % 3)) return false;
    triangle = next;
  }
  return false;
}

void Spreader::add(const geometry::SurfacePoint& point, double weight) {
  const auto& corners = surface_->surface().triangles[static_cast<std::size_t>(point.triangle)];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = static_cast<std::size_t>(corners[i]);
    if (share_[vertex] == 0.0) touched_.push_back(corners[i]);
    share_[vertex] += weight * point.weights[static_cast<Eigen::Index>(i)];
  }
}

void Spreader::spread(const Patch& patch, Spread& spread) {
  static const Pairs pairs = make_pairs();
  const Vec3 across = patch.normal.cross(patch.axis);
  touched_.clear();
  for (const Pair& pair : pairs) {
    const Vec3 arm = patch.a * pair.x * patch.axis + patch.b * pair.y * across;
    geometry::SurfacePoint one;
    geometry::SurfacePoint other;
    const auto both = [&](double part) {
      return meets(patch, patch.position + part * arm, one) &&
             meets(patch, patch.position - part * arm, other);
    };
    if (!both(1.0)) {
      double on = 0.0;
      double off = 1.0;
      for (int halving = 0; halving < 50; ++halving) {
        const double middle = 0.5 * (on + off);
        (both(middle) ? on : off) = middle;
      }
      if (!both(on)) one = other = patch.at;
    }
    add(one, pair.weight);
    add(other, pair.weight);
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  spread.vertices.clear();
  spread.shares.clear();
  for (const int vertex : touched_) {
    double& share = share_[static_cast<std::size_t>(vertex)];
    // Weights of -1e-12 from points on an edge cancel in sums; what is left of them is no load.
    if (share > 1e-14) {
      spread.vertices.push_back(vertex);
      spread.shares.push_back(share);
    }
    share = 0.0;
  }
}

}  // namespace palpate::contact
