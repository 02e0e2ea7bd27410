// Samples every shape as loops of points or as a box.
#include "geometry/shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "geometry/box_surface.h"
#include "geometry/shape_loops.h"

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

Vec3 extent(const Shape& shape) { return std::visit(Extent{}, shape); }

}  // namespace palpate::geometry
