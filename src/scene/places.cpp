// Boxes of bodies and regions, and the volume of a ball inside a surface.
#include "scene/places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {
namespace {

constexpr double least_inside = 0.99;

std::string range_text(double low, double high) {
  return rounded_text(unit::mm.from_si(low), 4) + " to " + rounded_text(unit::mm.from_si(high), 4);
}

// What is wrong with a region of which `inside` lies in the body; both are named with their boxes.
std::string outside(std::size_t region, double inside, const std::string& own,
                    const std::string& body, const std::string& remedy) {
  const std::string which = "`[[region]]` " + std::to_string(region + 1);
  return (inside > 0.0 ? "only " + percent_text(inside) + " of " + which + " lies inside the body"
                       : which + " lies outside the body") +
         ": it has " + own + ", the body " + body + "; " + remedy;
}

}  // namespace

std::string Box::text() const {
  return "x " + range_text(low.x(), high.x()) + ", y " + range_text(low.y(), high.y()) + ", z " +
         range_text(low.z(), high.z()) + " mm";
}

Box box_of(std::span<const Vec3> places) {
  Box box{places.front(), places.front()};
  for (const Vec3& place : places) {
    box.low = box.low.cwiseMin(place);
    box.high = box.high.cwiseMax(place);
  }
  return box;
}

std::string coordinates_text(const scenario::Resolved& scenario) {
  return parametric(scenario.tissue.shape) ? "from the lowest corner of its box"
                                           : "in the file's coordinates";
}

double base_level(const scenario::Resolved& scenario, const Box& body, bool stands_flat) {
  const double height = body.high.z() - body.low.z();
  return scenario.tissue.base_height.value_or(body.low.z() + (stands_flat ? 0.0 : 0.1 * height));
}

double share_inside(const geometry::Surface& body, const geometry::Lump& lump) {
  // Vertical lines through a lattice on the lump's disc; its offset avoids vertices and edges.
  constexpr int lines = 41;
  constexpr double offset = 0.4142;
  const double step = 2.0 * lump.radius / lines;
  const double r = lump.radius;
  const auto along = [&](int axis, int i) {
    return lump.centre[axis] - r + (i + offset + 0.01 * axis) * step;
  };
  std::vector<std::vector<double>> crossings(lines * lines);
  for (const auto& triangle : body.triangles) {
    const Vec3& a = body.vertices[as_index(triangle[0])];
    const Vec3& b = body.vertices[as_index(triangle[1])];
    const Vec3& c = body.vertices[as_index(triangle[2])];
    std::array<int, 2> first{}, last{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto index = [&](double at) {
        return std::clamp((at - along(axis, 0)) / step, -1.0, static_cast<double>(lines));
      };
      first[as_index(axis)] =
          std::max(0, static_cast<int>(std::ceil(index(std::min({a[axis], b[axis], c[axis]})))));
      last[as_index(axis)] = std::min(
          lines - 1, static_cast<int>(std::floor(index(std::max({a[axis], b[axis], c[axis]})))));
    }
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.z() == 0.0) continue;
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j) {
        const double x = along(0, i), y = along(1, j);
        const auto side = [&](const Vec3& from, const Vec3& to) {
          return (to.x() - from.x()) * (y - from.y()) - (to.y() - from.y()) * (x - from.x()) > 0.0;
        };
        if (side(a, b) != side(b, c) || side(b, c) != side(c, a)) continue;
        crossings[as_index(i * lines + j)].push_back(
            a.z() - (normal.x() * (x - a.x()) + normal.y() * (y - a.y())) / normal.z());
      }
  }
  double inside = 0.0, all = 0.0;
  for (int i = 0; i < lines; ++i)
    for (int j = 0; j < lines; ++j) {
      const double x = along(0, i) - lump.centre.x(), y = along(1, j) - lump.centre.y();
      const double half = std::sqrt(std::max(0.0, r * r - x * x - y * y));
      all += 2.0 * half;
      std::vector<double>& heights = crossings[as_index(i * lines + j)];
      std::sort(heights.begin(), heights.end());
      for (std::size_t k = 0; k + 1 < heights.size(); k += 2)
        inside += std::max(0.0, std::min(heights[k + 1], lump.centre.z() + half) -
                                    std::max(heights[k], lump.centre.z() - half));
    }
  return inside / all;
}

void refuse_outside(const scenario::Resolved& scenario, const geometry::Surface& body,
                    const scenario::Family& family) {
  const Box box = box_of(body.vertices);
  const std::string where = ", " + coordinates_text(scenario);
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    const std::string path = "region." + std::to_string(i + 1);
    if (const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part)) {
      const double inside =
          std::max(0.0, std::min(slab->top, box.high.z()) - std::max(slab->bottom, box.low.z()));
      const double share = inside / (slab->top - slab->bottom);
      if (share < least_inside)
        throw InputError(place_of(family.document, path + ".bottom"),
                         outside(i, share, "z " + range_text(slab->bottom, slab->top) + " mm",
                                 "z " + range_text(box.low.z(), box.high.z()) + " mm" + where,
                                 "change `bottom` and `top`"));
    }
    if (const auto* ball = std::get_if<scenario::Lump>(&scenario.regions[i].part)) {
      const Vec3 centre(ball->centre[0], ball->centre[1], ball->centre[2]);
      const double share = share_inside(body, {centre, ball->radius, 0});
      const Box own{centre - Vec3::Constant(ball->radius), centre + Vec3::Constant(ball->radius)};
      if (share < least_inside)
        throw InputError(
            place_of(family.document, path + ".centre"),
            outside(i, share, own.text(), box.text() + where, "change `centre` or `radius`"));
    }
  }
  const auto& height = scenario.tissue.base_height;
  if (height && (*height < box.low.z() || *height >= box.high.z()))
    throw InputError(place_of(family.document, "tissue.base_height"),
                     "the base ends at z " + rounded_text(unit::mm.from_si(*height), 4) +
                         " mm, but the body has z " + range_text(box.low.z(), box.high.z()) +
                         " mm" + where + "; give a height between the two");
}

void refuse_misplaced(const scenario::Resolved& scenario, const scenario::Family& family,
                      SpecimenShapes& shapes) {
  const bool placed =
      std::any_of(scenario.regions.begin(), scenario.regions.end(), [](const auto& region) {
        return !std::holds_alternative<scenario::TaggedRegion>(region.part);
      });
  if (!placed && !scenario.tissue.base_height) return;
  if (const auto shape = parametric(scenario.tissue.shape)) {
    constexpr double spacing_over_size = 0.02;  // a chord is then 1e-4 of the size inside
    const double spacing = spacing_over_size * geometry::extent(*shape).norm();
    refuse_outside(scenario, geometry::sampled(*shape, {spacing, spacing}).parts.front().surface,
                   family);
  } else if (const auto* file = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape)) {
    const auto surface = shapes.surface(*file, family.folder).surface;
    if (surface) refuse_outside(scenario, surface->surface(), family);
  }
}

}  // namespace palpate::scene
