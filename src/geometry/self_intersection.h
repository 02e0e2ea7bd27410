// Do two faces of a surface meet where they share neither vertex nor edge?
#pragma once

#include <array>
#include <optional>

#include "geometry/surface.h"

namespace palpate::geometry {

// The lowest pair of triangles that cut, touch or overlap each other beyond the vertices and edges
// that they share; nothing where there is none. Decided exactly, from the coordinates as they are:
// no tolerance. Some 0.3 s for 1e5 triangles.
//
// Needs an orientable manifold without flat triangles, open or closed: see surface_check.h.
[[nodiscard]] std::optional<std::array<int, 2>> self_intersection(const Surface& surface);

}  // namespace palpate::geometry
