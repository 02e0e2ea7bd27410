// Closed surfaces from loops of points: every loop is stitched to the next with triangles.
#pragma once

#include <functional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// Points around the surface, without a repeated last one. A single point is a pole; a loop that
// runs along a line and back names the points between its ends twice.
using Loop = std::vector<Vec3>;

// The surface through `loops`, each joined to the next by the shorter of the two possible edges,
// again and again. It closes where the first and last loops enclose nothing. The triangles look
// outwards where, seen from outside with the sequence running upwards, every loop runs to the
// right. Points that a loop names twice become one vertex.
[[nodiscard]] Surface stitched(const std::vector<Loop>& loops);

// A cross-section normal to y: two half circles joined by straight lines along x, or a circle.
struct Section {
  double straight = 0.0;  // m, half the length of a straight line
  double radius = 0.0;    // m, of the half circles
};

// A body along y from 0 to `length` with flat ends: its section at each height y, and those of
// what lies inside it from end to end, outermost first; each lies within the one before.
struct Sweep {
  double length;  // m
  double x, z;    // m, where all sections have their middles
  std::vector<std::function<Section(double)>> sections;
};

// How long edges are, about, in m: on a body's outer surface and on those inside it.
struct Spacing {
  double outer;
  double inner;

  [[nodiscard]] double of(std::size_t surface) const { return surface == 0 ? outer : inner; }
};

// One closed surface for each of the sweep's sections, its edges about `spacing` long, but with at
// least six vertices around. Every vertex of a side lies on it exactly. Where two of the
// surfaces share an end face, they have its vertices and triangles in common, bit for bit.
[[nodiscard]] std::vector<Surface> sweep_surfaces(const Sweep& sweep, const Spacing& spacing);

// An ellipsoid with these full axes (m) about `centre`, a vertex at each end of the axis along z.
[[nodiscard]] Surface ellipsoid_surface(const Vec3& centre, const Vec3& size, double spacing);

}  // namespace palpate::geometry
