// What CGAL does for surfaces: finds self-intersections, simplifies, remeshes, triangulates planes.
#pragma once

#include <array>
#include <optional>

#include <span>
#include <vector>

#include "geometry/surface.h"

namespace palpate::meshing::cgal_library {

// The pairs of triangles, sorted, that cut, touch or overlap each other apart from the vertices and
// edges that they share. The decision is exact for the given coordinates, without a tolerance.
// About 0.3 s for 1e5 triangles. The surface must be an orientable manifold without flat triangles,
// open or closed: see surface_repair.h.
[[nodiscard]] std::vector<std::array<int, 2>> self_intersections(const geometry::Surface& surface);

// Delaunay's triangles between points of a plane with these segments as edges, without what lies
// outside all segments; nothing if two segments cross, or the ends of one are at one place. No
// point is added.
[[nodiscard]] std::optional<std::vector<std::array<int, 3>>> triangulated(
    std::span<const Eigen::Vector2d> points, std::span<const std::array<int, 2>> segments);

// The two functions below take a closed surface without self-intersections, and may crash on
// others: call them in a child process only. The same arguments give the same bits.

// Collapses the shortest edge until none is shorter than about 0.7 of the `spacing` of its ends (m,
// of each vertex). Each new vertex preserves the volume and is near the planes around it, so that
// it stays on creases and in corners (Lindstrom & Turk 1998). A collapse that turns a triangle by
// more than 60 degrees or makes a needle is excluded.
[[nodiscard]] geometry::Surface collapsed(const geometry::Surface& surface,
                                          std::span<const double> spacing);

// Triangles of nearly equal sides with edges of about `spacing` (m) and vertices on the surface;
// edges with an angle above `crease_degrees` between their triangles remain (Botsch & Kobbelt
// 2004).
[[nodiscard]] geometry::Surface even(const geometry::Surface& surface, double spacing,
                                     double crease_degrees);

}  // namespace palpate::meshing::cgal_library
