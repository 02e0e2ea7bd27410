// Closed surfaces from loops of points that are connected by triangles.
#pragma once

#include <functional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// A cross-section normal to y: a circle, or two half circles connected by straight lines along x.
struct Section {
  double straight = 0.0;  // m, half the length of each straight line
  double radius = 0.0;    // m, of the half circles
};

// A body along y from 0 to `length` with flat ends: its section as a function of the height y, then
// those of the bodies inside it, which extend from end to end, from the outside inwards.
struct Sweep {
  double length;  // m
  double x, z;    // m, the middle of all sections
  std::vector<std::function<Section(double)>> sections;
};

// Approximate edge lengths, m: on a body's outer surface and on those inside it.
struct Spacing {
  double outer;
  double inner;

  [[nodiscard]] double of(std::size_t surface) const { return surface == 0 ? outer : inner; }
};

// One closed surface for each of the sweep's sections, with edges of about `spacing`, but at least
// six vertices around. Every vertex of a side is exactly on it. Where two surfaces share an end
// face, their vertices and triangles there are bitwise equal.
[[nodiscard]] std::vector<Surface> sweep_surfaces(const Sweep& sweep, const Spacing& spacing);

// An ellipsoid with full axes `size` and edges of about `spacing` (m); two vertices end its z axis.
[[nodiscard]] Surface ellipsoid_surface(const Vec3& centre, const Vec3& size, double spacing);

}  // namespace palpate::geometry
