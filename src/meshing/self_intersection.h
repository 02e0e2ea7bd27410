// Finds faces of a surface that intersect.
#pragma once

#include <array>
#include <optional>

#include "geometry/surface.h"

namespace palpate::meshing {

// The first pair of triangles (lowest indices) that cut, touch or overlap each other apart from the
// vertices and edges that they share; empty if there is none. The decision is exact for the given
// coordinates, without a tolerance. About 0.3 s for 1e5 triangles. The surface must be an
// orientable manifold without flat triangles, open or closed: see surface_check.h.
[[nodiscard]] std::optional<std::array<int, 2>> self_intersection(const geometry::Surface& surface);

}  // namespace palpate::meshing
