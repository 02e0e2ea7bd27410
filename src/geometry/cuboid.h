// A structured mesh: a box of cells, each cut into six tetrahedra.
#pragma once

#include <array>
#include <span>

#include "geometry/surface.h"
#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// A box from the origin to `size` (m), with `cells` along x, y and z, each at least 1. Every cell
// of a side is a rectangle cut in two; neighbouring cells are cut along different diagonals.
[[nodiscard]] Surface box_surface(const Vec3& size, const std::array<int, 3>& cells);

// Directions of the cells' space diagonals.
enum class CellPattern {
  kuhn,      // all from a cell's lowest corner to its highest
  mirrored,  // reflected along each axis in every second cell ("Union Jack")
};

// Grading of the cell size. Cells are smallest at `finest` (m, in the box); from there they grow
// along each axis, eventually geometrically, to `ratio` (at least 1) times that size at the
// farthest end of an axis. With 1 all cells are equal. A larger number of cells divides the same
// size function, so that the meshes of one grading form one family.
// docs/theory.md [cells]
struct Grading {
  double ratio = 1.0;
  Vec3 finest = Vec3::Zero();
};

// A box from the origin to `size` (m, each above 0), with `cells` along x, y and z, each at least
// 1. Every cell becomes the six path tetrahedra 000 -> ... -> 111, one for each order of the axes
// (Kuhn 1960; Freudenthal 1942), so that neighbouring cells share whole faces. Nodes are numbered x
// fastest, then y, then z. With `mirrored` and even counts the mesh is symmetric about the three
// middle planes of the box (if graded, about the planes through `finest`). At every height of
// `levels` (m, ascending, inside the box) the nearest cell border is moved to that height. Throws
// MeshError if there are more tetrahedra than an int can count, or fewer inner borders than levels.
[[nodiscard]] TetMesh cuboid(const Vec3& size, const std::array<int, 3>& cells, CellPattern pattern,
                             const Grading& grading = {}, std::span<const double> levels = {});

}  // namespace palpate::geometry
