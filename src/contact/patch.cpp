// Distributes Hertz's pressure: a quadrature in polar coordinates and walks over the triangles.
#include "contact/patch.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "base/numerics.h"

namespace palpate::contact {
namespace {

constexpr std::size_t ring_count = 6;
constexpr std::size_t spoke_count = 8;  // each with two sides

// Quadrature points on ellipses about the centre, in units of the semi-axes: one at every radius
// and spoke, and one opposite of it.
struct Quadrature {
  struct Ring {
    double radius;
    double weight;  // of each of its points; the sum over all points is 1
  };
  std::array<Ring, ring_count> rings;                     // by growing radii
  std::array<std::array<double, 2>, spoke_count> spokes;  // to the points farthest out
};

// With s = sqrt(1 - r^2/a^2) the force p r dr becomes s^2 ds on [0, 1]: Gauss-Legendre points in s
// and equal angles.                                                     docs/theory.md [shares]
Quadrature make_quadrature() {
  const numerics::GaussRule& rule = numerics::gauss_rule(static_cast<int>(ring_count));
  Quadrature found{};
  for (std::size_t ring = 0; ring < found.rings.size(); ++ring) {
    const std::size_t i = found.rings.size() - 1 - ring;
    const double s = 0.5 + 0.5 * rule.nodes[i];
    found.rings[ring] = {std::sqrt(1.0 - s * s),
                         3.0 * s * s * 0.5 * rule.weights[i] / (2 * spoke_count)};
  }
  for (std::size_t spoke = 0; spoke < found.spokes.size(); ++spoke) {
    const double angle = std::numbers::pi * (static_cast<double>(spoke) + 0.5) / spoke_count;
    const double farthest = found.rings.back().radius;
    found.spokes[spoke] = {farthest * std::cos(angle), farthest * std::sin(angle)};
  }
  return found;
}

// Made before the first step, which allocates nothing.
const Quadrature quadrature = make_quadrature();

static_assert(most_shares == 3 * 2 * ring_count * spoke_count);

constexpr std::size_t most_stretches = 1000;
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
  ahead_.reserve(most_stretches);
  back_.reserve(most_stretches);
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

void Spreader::follow(double x, double y, std::vector<Stretch>& way) {
  way.clear();
  Stretch stretch{.triangle = from_.at.triangle};
  int before = -1;
  while (view(stretch.triangle).faces && way.size() < most_stretches) {
    const View& seen = view(stretch.triangle);
    const double second = x * seen.second_x + y * seen.second_y;
    const double third = x * seen.third_x + y * seen.third_y;
    const std::array weights{1.0 - seen.second - seen.third, seen.second, seen.third};
    const std::array changes{-second - third, second, third};
    // The way leaves the triangle where the first weight falls to 0, but not back where it came.
    double end = 1.0;
    int next = -1;
    std::size_t edge = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (!(changes[corner] < 0.0 && weights[corner] < -end * changes[corner])) continue;
      const std::size_t opposite = (corner + 1) % 3;  // it starts at the next corner
      const int beyond = surface_->neighbours().across(stretch.triangle)[opposite];
      if (beyond >= 0 && beyond == before) continue;
      end = -weights[corner] / changes[corner];
      next = beyond;
      edge = opposite;
    }
    stretch.end = std::clamp(end, stretch.end, 1.0);
    way.push_back(stretch);
    // Not across a crease: the other side would be loaded suddenly, as soon as it faces the patch.
    if (next < 0 || surface_->crease(stretch.triangle, edge)) break;
    before = std::exchange(stretch.triangle, next);
  }
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
  for (const auto& spoke : quadrature.spokes) {
    const double x = patch.a * spoke[0];
    const double y = patch.b * spoke[1];
    follow(x, y, ahead_);
    follow(-x, -y, back_);
    auto one = ahead_.begin();
    auto other = back_.begin();
    for (const Quadrature::Ring& ring : quadrature.rings) {
      if (ahead_.empty()) {
        share(patch.at, 2.0 * ring.weight);
        continue;
      }
      const double part = std::min(
          {ring.radius / quadrature.rings.back().radius, ahead_.back().end, back_.back().end});
      while (one->end < part) ++one;
      while (other->end < part) ++other;
      add(one->triangle, part * x, part * y, ring.weight);
      add(other->triangle, -part * x, -part * y, ring.weight);
    }
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
  std::ranges::sort(touched_);
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

PatchField::PatchField(double a, double b, const HalfSpace& half_space, int finer,
                       const Vec3& along)
    : half_space_(half_space), along_(along), reach_(std::max(a, b)) {
  constexpr std::array<std::array<int, 2>, 3> rings_and_spokes{{{2, 6}, {4, 12}, {10, 30}}};
  for (std::size_t level = 0; level < loads_.size(); ++level) {
    const int rings = finer * rings_and_spokes[level][0];
    const int spokes = finer * rings_and_spokes[level][1];
    // With v^2 = 1 - s^2 the load inside the radius s is the integral of 3 v^2 dv: polynomials in
    // s^2 are integrated exactly by a Gauss-Legendre rule for even functions of v.
    const numerics::GaussRule& rule = numerics::gauss_rule(2 * rings);
    for (int ring = 0; ring < rings; ++ring) {
      const auto outermost = as_index(2 * rings - 1 - ring);  // of those that are left, v > 0
      const double v = rule.nodes[outermost];
      const double s = std::sqrt(1.0 - v * v);
      const double share = 3.0 * v * v * rule.weights[outermost] / spokes;
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = 2.0 * std::numbers::pi * (spoke + 0.5 * (ring % 2)) / spokes;
        loads_[level].x.push_back(a * s * std::cos(angle));
        loads_[level].y.push_back(b * s * std::sin(angle));
        loads_[level].share.push_back(share);
      }
    }
    for (std::vector<double>* of : {&loads_[level].x, &loads_[level].y, &loads_[level].share})
      of->resize((of->size() + 7) / 8 * 8, 0.0);
  }
}

FieldValue PatchField::at(const Vec3& point) const {
  const double distance = point.norm() / reach_;
  const PointLoads& loads = loads_[distance > 8.0 ? 0 : distance > 3.0 ? 1 : 2];
  const double depth = std::max(-point.z(), 0.0);
  const double least = 1e-12 * reach_ * reach_;
  const double nu = half_space_.poisson_ratio;
  const PointField sums =
      along_.z() < -0.5
          ? boussinesq(loads, point.x(), point.y(), depth, least, nu)
          : cerruti(loads, point.x(), point.y(), depth, least, nu, along_.x(), along_.y());
  FieldValue value;
  value.displacement =
      Vec3(sums.ux, sums.uy, sums.uz) / (4.0 * std::numbers::pi * half_space_.shear_modulus);
  value.stress << sums.xx, sums.xy, sums.xz, sums.xy, sums.yy, sums.yz, sums.xz, sums.yz, sums.zz;
  value.stress /= 2.0 * std::numbers::pi;
  return value;
}

SurfaceSpacing::SurfaceSpacing(const geometry::SmoothSurface& surface)
    : part_(surface.surface().triangles.size(), -1) {
  for (std::size_t t = 0; t < part_.size(); ++t) {
    if (part_[t] >= 0) continue;
    const int part = static_cast<int>(spacing_.size());
    std::vector<int> found{static_cast<int>(t)};
    part_[t] = part;
    double area = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      area += 0.5 * twice_area(surface.surface(), found[i]).norm();
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (surface.crease(found[i], edge)) continue;
        const int next = surface.neighbours().across(found[i])[edge];
        if (part_[as_index(next)] >= 0) continue;
        part_[as_index(next)] = part;
        found.push_back(next);
      }
    }
    // l = sqrt(4 A / sqrt(3))
    spacing_.push_back(
        std::sqrt(4.0 * area / (std::sqrt(3.0) * static_cast<double>(found.size()))));
  }
}

double SurfaceSpacing::at(const Patch& patch) const {
  const auto of = [&](int triangle) { return spacing_[as_index(part_[as_index(triangle)])]; };
  const double here = of(patch.at.triangle);
  return patch.turned > 0.0 ? here + patch.turned * (of(patch.beyond.triangle) - here) : here;
}

}  // namespace palpate::contact
