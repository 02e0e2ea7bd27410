// Distributes Hertz's pressure: a quadrature in polar coordinates and a walk over the triangles.
#include "contact/patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate::contact {
namespace {

constexpr int rings = 6;
constexpr int half_spokes = 8;

// A quadrature point, in units of the semi-axes; the opposite point has the same weight.
struct Pair {
  double x, y;
  double weight;  // of each of the two; the sum over all points is 1
};
using Pairs = std::array<Pair, as_index(rings* half_spokes)>;

// With s = sqrt(1 - r^2/a^2) the force p r dr becomes s^2 ds on [0, 1]: Gauss-Legendre points in s
// and equal angles. 6-point abscissae: Abramowitz & Stegun 1964, table 25.4. docs/theory.md (9)
Pairs make_pairs() {
  constexpr std::array abscissae{0.238619186083196909, 0.661209386466264514, 0.932469514203152028};
  constexpr std::array weights{0.467913934572691047, 0.360761573048138608, 0.171324492379170345};
  Pairs pairs{};
  std::size_t next = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t i = as_index(ring) / 2;
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

static_assert(most_shares == 3 * 2 * as_index(rings * half_spokes));

constexpr double least_facing = 0.2;  // cosine; below it a triangle counts as turned away

}  // namespace

double Patch::radius() const { return std::sqrt(a * b); }

Spreader::Spreader(const geometry::SmoothSurface& surface)
    : surface_(&surface),
      share_(surface.surface().vertices.size(), 0.0),
      views_(surface.surface().triangles.size()) {}

void Spreader::make_room() {
  touched_.reserve(most_shares);
  met_.reserve(most_shares / 3);
}

// Views depend on position and directions, not on the size of the patch.
void Spreader::look_from(const Patch& patch) {
  const bool same = turn_ > 0 && patch.position == from_.position && patch.normal == from_.normal &&
                    patch.axis == from_.axis;
  from_ = patch;
  if (!same) ++turn_;
}

void Spreader::look_at(int triangle, View& view) const {
  view.turn = turn_;
  const geometry::Surface& surface = surface_->surface();
  const auto& [i, j, k] = surface.triangles[as_index(triangle)];
  const Vec3& corner = surface.vertices[as_index(i)];
  const Vec3 side_b = surface.vertices[as_index(j)] - corner;
  const Vec3 side_c = surface.vertices[as_index(k)] - corner;
  const Vec3 upright = side_b.cross(side_c);
  const double seen = upright.dot(from_.normal);
  view.faces = seen >= least_facing * upright.norm();
  if (!view.faces) return;
  // w_2 = n . (p - corner) x c / (n . b x c), and w_3 likewise with b x (p - corner)
  const Vec3 second = side_c.cross(from_.normal) / seen;
  const Vec3 third = from_.normal.cross(side_b) / seen;
  const Vec3 across = from_.normal.cross(from_.axis);
  const Vec3 away = from_.position - corner;
  view.second = second.dot(away);
  view.second_x = second.dot(from_.axis);
  view.second_y = second.dot(across);
  view.third = third.dot(away);
  view.third_x = third.dot(from_.axis);
  view.third_y = third.dot(across);
}

// Walks from the patch's triangle to the one that contains the point, seen along the normal, or -1.
int Spreader::triangle_at(double x, double y) {
  constexpr int most_steps = 1000;
  int triangle = from_.at.triangle;
  for (int step = 0; step < most_steps; ++step) {
    const View& seen = view(triangle);
    if (!seen.faces) return -1;
    const double second = seen.second + x * seen.second_x + y * seen.second_y;
    const double third = seen.third + x * seen.third_x + y * seen.third_y;
    // The edge opposite to the corner with the lowest weight starts at the next corner.
    double lowest = 1.0 - second - third;
    std::size_t edge = 1;
    if (second < lowest) {
      edge = 2;
      lowest = second;
    }
    if (third < lowest) {
      edge = 0;
      lowest = third;
    }
    constexpr double rounding = 1e-12;
    if (lowest >= -rounding) return triangle;
    const int next = surface_->neighbours().across(triangle)[edge];
    if (next < 0 && lowest >= -1e-9) return triangle;
    // Not across a crease: the other side would be loaded suddenly, as soon as it faces the patch.
    if (surface_->crease(triangle, edge)) return -1;
    triangle = next;
  }
  return -1;
}

void Spreader::share(const geometry::SurfacePoint& point, double weight) {
  const auto& corners = surface_->surface().triangles[as_index(point.triangle)];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = as_index(corners[i]);
    if (share_[vertex] == 0.0) touched_.push_back(corners[i]);
    share_[vertex] += weight * point.weights[static_cast<Eigen::Index>(i)];
  }
}

void Spreader::spread(const Patch& patch, Spread& spread) {
  static const Pairs pairs = make_pairs();
  look_from(patch);
  touched_.clear();
  met_.clear();
  // Shares are linear over a triangle, so the sums over its quadrature points suffice.
  const auto add = [this](int triangle, double x, double y, double weight) {
    View& seen = view(triangle);
    if (seen.weight == 0.0) met_.push_back(triangle);
    seen.weight += weight;
    seen.weight_x += weight * x;
    seen.weight_y += weight * y;
  };
  for (const Pair& pair : pairs) {
    const double x = patch.a * pair.x;
    const double y = patch.b * pair.y;
    int one = triangle_at(x, y);
    int other = one < 0 ? -1 : triangle_at(-x, -y);
    double part = 1.0;
    if (other < 0) {
      part = 0.0;
      double off = 1.0;
      for (int halving = 0; halving < 24; ++halving) {
        const double middle = 0.5 * (part + off);
        const bool on =
            triangle_at(middle * x, middle * y) >= 0 && triangle_at(-middle * x, -middle * y) >= 0;
        (on ? part : off) = middle;
      }
      one = triangle_at(part * x, part * y);
      other = one < 0 ? -1 : triangle_at(-part * x, -part * y);
    }
    if (other < 0) {
      share(patch.at, 2.0 * pair.weight);
      continue;
    }
    add(one, part * x, part * y, pair.weight);
    add(other, -part * x, -part * y, pair.weight);
  }
  for (const int triangle : met_) {
    View& seen = view(triangle);
    const double second =
        seen.weight * seen.second + seen.weight_x * seen.second_x + seen.weight_y * seen.second_y;
    const double third =
        seen.weight * seen.third + seen.weight_x * seen.third_x + seen.weight_y * seen.third_y;
    share({triangle, Vec3(seen.weight - second - third, second, third)}, 1.0);
    seen.weight = seen.weight_x = seen.weight_y = 0.0;
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  spread.vertices.clear();
  spread.shares.clear();
  for (const int vertex : touched_) {
    double& share = share_[as_index(vertex)];
    // Weights of -1e-12 from points on an edge cancel in the sums; the rounding left over is no
    // load.
    if (share > 1e-14) {
      spread.vertices.push_back(vertex);
      spread.shares.push_back(share);
    }
    share = 0.0;
  }
}

}  // namespace palpate::contact
