// Samples every shape as loops of points or as a box.
#include "geometry/shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/numerics.h"
#include "base/text.h"
#include "geometry/cuboid.h"

namespace palpate::geometry {
namespace {

constexpr double ligament_ends =
    1.2;  // width and thickness of the ends divided by those of the middle: assumed

// 0 in the middle of the length, 1 at both ends.
double towards_ends(double y, double length) {
  const double part = 2.0 * (y / length) - 1.0;
  return part * part;
}

Body one_part(Surface surface) { return {{{std::move(surface), 0}}}; }

Body one_part(const Sweep& sweep, const Spacing& spacing) {
  return one_part(std::move(sweep_surfaces(sweep, spacing).front()));
}

Sweep sweep_of(const Cylinder& cylinder) {
  const auto section = [=](double) { return Section{0.0, cylinder.radius}; };
  return {cylinder.length, cylinder.radius, cylinder.radius, {section}};
}

Sweep sweep_of(const Ligament& ligament) {
  assert(ligament.width > ligament.thickness);
  const auto section = [=](double y) {
    const double factor = 1.0 + (ligament_ends - 1.0) * towards_ends(y, ligament.length);
    return Section{0.5 * factor * (ligament.width - ligament.thickness),
                   0.5 * factor * ligament.thickness};
  };
  const Vec3 middle = 0.5 * extent(ligament);
  return {ligament.length, middle.x(), middle.z(), {section}};
}

Sweep sweep_of(const BoneShaft& bone) {
  const auto section = [=](double y) {
    const double part = towards_ends(y, bone.length);
    return Section{0.0, bone.radius + (bone.end_radius - bone.radius) * part * part};
  };
  const Vec3 middle = 0.5 * extent(bone);
  return {bone.length, middle.x(), middle.z(), {section}};
}

// The skin, then the muscle's surface if there is skin, then the bone's if there is a bone.
Sweep sweep_of(const LayeredLimb& limb) {
  const auto inset = [=](double depth) {
    return [=](double y) {
      return Section{0.0,
                     limb.radius + (limb.end_radius - limb.radius) * (y / limb.length) - depth};
    };
  };
  const Vec3 middle = 0.5 * extent(limb);
  Sweep sweep{limb.length, middle.x(), middle.z(), {inset(0.0)}};
  if (limb.skin_thickness > 0.0) sweep.sections.push_back(inset(limb.skin_thickness));
  if (limb.bone_radius > 0.0)
    sweep.sections.push_back([=](double) { return Section{0.0, limb.bone_radius}; });
  return sweep;
}

struct Sampler {
  Spacing spacing;

  Body operator()(const Cuboid& cuboid) const {
    std::array<int, 3> cells{};
    for (int axis = 0; axis < 3; ++axis)
      cells[as_index(axis)] =
          std::max(1, static_cast<int>(std::lround(cuboid.size[axis] / spacing.outer)));
    return one_part(box_surface(cuboid.size, cells));
  }

  Body operator()(const Ellipsoid& ellipsoid) const {
    return one_part(ellipsoid_surface(0.5 * ellipsoid.size, ellipsoid.size, spacing.outer));
  }

  // A bar that is turned about x to stand on its end.
  Body operator()(const Disc& disc) const {
    Body body = one_part(sweep_of(Cylinder{disc.radius, disc.height}), spacing);
    for (Vec3& v : body.parts.front().surface.vertices)
      v = Vec3(v.x(), 2.0 * disc.radius - v.z(), v.y());
    return body;
  }

  template <class Bar>
  Body operator()(const Bar& bar) const {
    return one_part(sweep_of(bar), spacing);
  }

  Body operator()(const LayeredLimb& limb) const {
    const double thinnest = std::min(limb.radius, limb.end_radius);
    if (limb.skin_thickness + limb.bone_radius >= thinnest)
      throw MeshError("a limb of radius " + rounded_text(1e3 * thinnest) +
                      " mm has no room for muscle between a skin of " +
                      rounded_text(1e3 * limb.skin_thickness) + " mm and a bone of radius " +
                      rounded_text(1e3 * limb.bone_radius) + " mm; make one of them thinner");
    const bool skin = limb.skin_thickness > 0.0;
    std::vector<int> regions{skin ? 0 : 1};
    if (skin) regions.push_back(1);
    if (limb.bone_radius > 0.0) regions.push_back(2);
    // A chord h of a circle of radius R is at most h^2 / (8 R) inside it: half of the thickness.
    const auto chord = [](double radius, double thickness) {
      return 2.0 * std::sqrt(radius * thickness);
    };
    const double muscle = thinnest - limb.skin_thickness;
    const Spacing fine{std::min(spacing.outer, skin ? chord(thinnest, limb.skin_thickness)
                                                    : chord(thinnest, muscle - limb.bone_radius)),
                       std::min(spacing.inner, chord(muscle, muscle - limb.bone_radius))};
    Body body;
    std::vector<Surface> surfaces = sweep_surfaces(sweep_of(limb), fine);
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      body.parts.push_back({std::move(surfaces[s]), regions[s]});
    return body;
  }
};

struct OuterSweep {
  std::optional<Sweep> operator()(const Cuboid&) const { return std::nullopt; }
  std::optional<Sweep> operator()(const Ellipsoid&) const { return std::nullopt; }
  std::optional<Sweep> operator()(const Disc&) const { return std::nullopt; }
  template <class Bar>
  std::optional<Sweep> operator()(const Bar& bar) const {
    Sweep sweep = sweep_of(bar);
    sweep.sections.resize(1);
    return sweep;
  }
};

// The point of the section's outline in the direction of a point from its middle.
Vec3 outline_point(const Sweep& sweep, const Section& section, const Vec3& point) {
  const double across = point.x() - sweep.x;
  const double end = std::clamp(across, -section.straight, section.straight);
  const Vec3 away(across - end, 0.0, point.z() - sweep.z);
  const double distance = away.norm();
  if (!(distance > 0.0)) return point;
  return Vec3(sweep.x + end, point.y(), sweep.z) + section.radius / distance * away;
}

// The place on a round surface, or on the nearest one, and its number.
struct Onto {
  const Vec3& point;
  std::optional<int> surface = {};

  std::pair<Vec3, int> operator()(const Cuboid&) const { return {point, 0}; }
  std::pair<Vec3, int> operator()(const Ellipsoid& ellipsoid) const {
    const Vec3 half = 0.5 * ellipsoid.size;
    const Vec3 away = point - half;
    return {half + away / away.cwiseQuotient(half).norm(), 0};
  }
  std::pair<Vec3, int> operator()(const Disc& disc) const {
    const Vec3 axis(disc.radius, disc.radius, point.z());
    const double distance = (point - axis).norm();
    return {distance > 0.0 ? Vec3(axis + disc.radius / distance * (point - axis)) : point, 0};
  }
  template <class Bar>
  std::pair<Vec3, int> operator()(const Bar& bar) const {
    const Sweep sweep = sweep_of(bar);
    std::pair<Vec3, int> nearest{point, 0};
    double least = std::numeric_limits<double>::infinity();
    for (int s = 0; s < static_cast<int>(sweep.sections.size()); ++s) {
      const Vec3 there = outline_point(sweep, sweep.sections[as_index(s)](point.y()), point);
      if ((surface && s != *surface) || (there - point).norm() >= least) continue;
      least = (there - point).norm();
      nearest = {there, s};
    }
    return nearest;
  }
};

struct Extent {
  Vec3 operator()(const Cuboid& cuboid) const { return cuboid.size; }
  Vec3 operator()(const Cylinder& cylinder) const {
    return {2.0 * cylinder.radius, cylinder.length, 2.0 * cylinder.radius};
  }
  Vec3 operator()(const Ellipsoid& ellipsoid) const { return ellipsoid.size; }
  Vec3 operator()(const Ligament& ligament) const {
    return {ligament_ends * ligament.width, ligament.length, ligament_ends * ligament.thickness};
  }
  Vec3 operator()(const BoneShaft& bone) const {
    const double radius = std::max(bone.radius, bone.end_radius);
    return {2.0 * radius, bone.length, 2.0 * radius};
  }
  Vec3 operator()(const Disc& disc) const {
    return {2.0 * disc.radius, 2.0 * disc.radius, disc.height};
  }
  Vec3 operator()(const LayeredLimb& limb) const {
    const double radius = std::max(limb.radius, limb.end_radius);
    return {2.0 * radius, limb.length, 2.0 * radius};
  }
};

}  // namespace

Body sampled(const Shape& shape, const Spacing& spacing) {
  assert(spacing.outer > 0.0 && spacing.inner > 0.0);
  return std::visit(Sampler{spacing}, shape);
}

Vec3 onto(const Shape& shape, const Vec3& point) { return std::visit(Onto{point}, shape).first; }

Vec3 onto(const Shape& shape, const Vec3& point, int surface) {
  return std::visit(Onto{point, surface}, shape).first;
}

int nearest_surface(const Shape& shape, const Vec3& point) {
  return std::visit(Onto{point}, shape).second;
}

std::optional<Sweep> outer_sweep(const Shape& shape) { return std::visit(OuterSweep{}, shape); }

int axis_of(const Shape& shape) { return std::holds_alternative<Disc>(shape) ? 2 : 1; }

bool stands(const Shape& shape) {
  return std::holds_alternative<Cuboid>(shape) || std::holds_alternative<Disc>(shape);
}

Vec3 extent(const Shape& shape) { return std::visit(Extent{}, shape); }

namespace {

// mm, before scaling.
constexpr double half_breadth = 9.0;
constexpr double nail_height = 8.0;  // above the axis
constexpr double pad_depth = 7.0;    // below it
constexpr double whole_length = 26.0;
constexpr double tip_length = 10.0;  // the rounded part of the length

// A ring: `cosine` is 0 on the finger's body and 1 at the tip.
struct Ring {
  int count;
  double cosine;
  double x;  // mm
};

// Rings with an even count have vertices on the middle lines of nail and pad, so that the triangles
// between them are mirror-symmetric. With the base's 15 the number of triangles is odd:
// 2 (6 + 12 + 4 x 16) + 15 = 179.
std::array<Ring, 7> rings() {
  const double half_root_3 = std::sqrt(3.0) / 2.0;
  const double body = whole_length - tip_length;
  return {{{6, half_root_3, body + tip_length * half_root_3},  // 30 degrees off the axis
           {12, 0.5, body + tip_length * 0.5},                 // 60 degrees
           {16, 0.0, body},
           {16, 0.0, 0.75 * body},
           {16, 0.0, 0.5 * body},
           {16, 0.0, 0.25 * body},
           {15, 0.0, 0.0}}};
}

// The vertex of a ring at `angle` from the pad's middle line, counter-clockwise seen from the tip.
Vec3 on_ring(const Ring& ring, double angle) {
  // The outline from above and the nail side are ellipses. The pad side and the pad's middle line
  // are flatter: |y|^4 + |z|^4 = 1 and |x|^4 + |z|^4 = 1. docs/theory.md [fingertip]
  const double square = ring.cosine * ring.cosine;
  const double round = std::sqrt(1.0 - square);
  const double flat = std::sqrt(std::sqrt(1.0 - square * square));
  const double right = std::sin(angle);
  const double down = std::cos(angle);
  if (down <= 0.0) return {ring.x, half_breadth * round * right, -nail_height * round * down};
  const double reach = 1.0 / std::sqrt(std::hypot(right * right, down * down));
  return {ring.x, half_breadth * round * right * reach, -pad_depth * flat * down * reach};
}

// Triangles between a ring of `inner` vertices, starting at `inner_first`, and the next ring
// towards the base, from the pad's middle line upwards on one side and mirrored on the other.
void join(int inner_first, int inner, int outer_first, int outer, Surface& surface) {
  const auto add = [&](int a, int b, int c) { surface.triangles.push_back({a, b, c}); };
  const auto in = [&](int i) { return inner_first + (i + inner) % inner; };
  const auto out = [&](int i) { return outer_first + (i + outer) % outer; };
  int i = 0;
  int o = 0;
  while (i < inner / 2 || o < outer / 2) {
    // The next vertex with the smaller angle comes first; angles are 2 pi i / count.
    if (i < inner / 2 && (o == outer / 2 || (i + 1) * outer <= (o + 1) * inner)) {
      add(in(i), out(o), in(i + 1));
      add(in(-i), in(-i - 1), out(-o));
      ++i;
    } else {
      add(in(i), out(o), out(o + 1));
      add(in(-i), out(-o - 1), out(-o));
      ++o;
    }
  }
  if (outer % 2 != 0) add(in(i), out(o), out(o + 1));  // across the middle line of the nail
}

}  // namespace

Surface fingertip(double volume) {
  Surface surface;
  surface.vertices.emplace_back(whole_length, 0.0, 0.0);
  int inner_first = 0;
  int inner = 1;
  for (const Ring& ring : rings()) {
    const int first = static_cast<int>(surface.vertices.size());
    for (int i = 0; i < ring.count; ++i) {
      // The left half is the exact mirror image of the right half.
      const int right = i <= ring.count / 2 ? i : ring.count - i;
      Vec3 vertex = on_ring(ring, 2.0 * std::numbers::pi * right / ring.count);
      if (2 * right == ring.count) vertex.y() = 0.0;
      if (right != i) vertex.y() = -vertex.y();
      surface.vertices.push_back(vertex);
    }
    join(inner_first, inner, first, ring.count, surface);
    inner_first = first;
    inner = ring.count;
  }
  const double scale = std::cbrt(volume / enclosed(with_closed_base(surface)).volume);
  for (Vec3& vertex : surface.vertices) vertex *= scale;
  return surface;
}

Surface with_closed_base(const Surface& open) {
  const Neighbours neighbours(open);
  Surface closed = open;
  const int centre = static_cast<int>(open.vertices.size());
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t t = 0; t < open.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      if (neighbours.across(static_cast<int>(t))[i] >= 0) continue;
      const int from = open.triangles[t][i];
      const int to = open.triangles[t][(i + 1) % 3];
      closed.triangles.push_back({to, from, centre});
      sum += open.vertices[as_index(from)];
      ++count;
    }
  if (count > 0) closed.vertices.push_back(sum / count);
  return closed;
}

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

// The curvature of the surface f = 0 from the gradient of f, which points outwards, and its second
// derivatives.                                                       docs/theory.md [level_set]
Curvature level_curvature(const Vec3& gradient, const Eigen::Matrix3d& second) {
  const double length = gradient.norm();
  const Vec3 normal = gradient / length;
  const auto [a, b] = tangent_axes(normal);
  return principal(
      normal, {a.dot(second * a) / length, a.dot(second * b) / length, b.dot(second * b) / length});
}

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

std::optional<ShapeTouch> touch_from_above(const Shape& shape, double x, double y, double radius) {
  if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape))
    return touch_ellipsoid(*ellipsoid, x, y, radius);
  if (const auto sweep = outer_sweep(shape)) return touch_sweep(*sweep, x, y, radius);
  const Vec3 size = extent(shape);
  double past = 0.0;  // beyond the flat top
  if (const auto* disc = std::get_if<Disc>(&shape))
    past = std::max(0.0, std::hypot(x - disc->radius, y - disc->radius) - disc->radius);
  else
    past = std::hypot(std::max({0.0, -x, x - size.x()}), std::max({0.0, -y, y - size.y()}));
  if (past >= radius) return std::nullopt;
  if (past > 0.0) return on_edge();
  ShapeTouch touch;
  touch.position = {x, y, size.z()};
  return touch;
}

}  // namespace palpate::geometry
