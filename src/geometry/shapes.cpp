// Samples every shape as loops of points or as a box.
#include "geometry/shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
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

Section limb_section(const LayeredLimb& limb, double y) {
  return {0.0, limb.radius + (limb.end_radius - limb.radius) * (y / limb.length)};
}

Body one_part(Surface surface) { return {{{std::move(surface), 0}}}; }

Body one_part(const Sweep& sweep, const Spacing& spacing) {
  return one_part(std::move(sweep_surfaces(sweep, spacing).front()));
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

  Body operator()(const Cylinder& cylinder) const {
    return one_part(*outer_sweep(cylinder), spacing);
  }
  Body operator()(const BoneShaft& bone) const { return one_part(*outer_sweep(bone), spacing); }
  Body operator()(const Ligament& ligament) const {
    assert(ligament.width > ligament.thickness);
    return one_part(*outer_sweep(ligament), spacing);
  }

  Body operator()(const LayeredLimb& limb) const {
    const double thinnest = std::min(limb.radius, limb.end_radius);
    if (limb.skin_thickness + limb.bone_radius >= thinnest)
      throw MeshError("a limb of radius " + rounded_text(1e3 * thinnest) +
                      " mm has no room for muscle between a skin of " +
                      rounded_text(1e3 * limb.skin_thickness) + " mm and a bone of radius " +
                      rounded_text(1e3 * limb.bone_radius) + " mm; make one of them thinner");
    const bool skin = limb.skin_thickness > 0.0;
    Sweep sweep = *outer_sweep(limb);
    std::vector<int> regions{skin ? 0 : 1};
    if (skin) {
      sweep.sections.push_back([=](double y) {
        Section section = limb_section(limb, y);
        section.radius -= limb.skin_thickness;
        return section;
      });
      regions.push_back(1);
    }
    if (limb.bone_radius > 0.0) {
      sweep.sections.push_back([=](double) { return Section{0.0, limb.bone_radius}; });
      regions.push_back(2);
    }
    // A chord h of a circle of radius R is at most h^2 / (8 R) inside it: half of the thickness.
    const auto chord = [](double radius, double thickness) {
      return 2.0 * std::sqrt(radius * thickness);
    };
    const double muscle = thinnest - limb.skin_thickness;
    const Spacing fine{std::min(spacing.outer, skin ? chord(thinnest, limb.skin_thickness)
                                                    : chord(thinnest, muscle - limb.bone_radius)),
                       std::min(spacing.inner, chord(muscle, muscle - limb.bone_radius))};
    Body body;
    std::vector<Surface> surfaces = sweep_surfaces(sweep, fine);
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      body.parts.push_back({std::move(surfaces[s]), regions[s]});
    return body;
  }
};

// The outermost section of each shape along y.
struct Outline {
  using Function = std::function<Section(double)>;

  Function operator()(const Cuboid&) const { return {}; }
  Function operator()(const Ellipsoid&) const { return {}; }
  Function operator()(const Cylinder& cylinder) const {
    return [=](double) { return Section{0.0, cylinder.radius}; };
  }
  Function operator()(const Ligament& ligament) const {
    return [=](double y) {
      const double factor = 1.0 + (ligament_ends - 1.0) * towards_ends(y, ligament.length);
      return Section{0.5 * factor * (ligament.width - ligament.thickness),
                     0.5 * factor * ligament.thickness};
    };
  }
  Function operator()(const BoneShaft& bone) const {
    return [=](double y) {
      const double part = towards_ends(y, bone.length);
      return Section{0.0, bone.radius + (bone.end_radius - bone.radius) * part * part};
    };
  }
  Function operator()(const LayeredLimb& limb) const {
    return [=](double y) { return limb_section(limb, y); };
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

std::optional<Sweep> outer_sweep(const Shape& shape) {
  const auto section = std::visit(Outline{}, shape);
  if (!section) return std::nullopt;
  const Vec3 size = extent(shape);
  return Sweep{size.y(), 0.5 * size.x(), 0.5 * size.z(), {section}};
}

Vec3 extent(const Shape& shape) { return std::visit(Extent{}, shape); }

}  // namespace palpate::geometry
