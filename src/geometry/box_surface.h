// The six sides of a box as grids of triangles.
#pragma once

#include <array>

#include "geometry/surface.h"

namespace palpate::geometry {

// A box from the origin to `size` (m), with `cells` along x, y and z, each at least 1. Every cell
// of a side is a rectangle cut in two; neighbouring cells are cut along different diagonals.
[[nodiscard]] Surface box_surface(const Vec3& size, const std::array<int, 3>& cells);

}  // namespace palpate::geometry
