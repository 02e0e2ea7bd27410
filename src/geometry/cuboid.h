// A box cut into regular cells of six tetrahedra each.
#pragma once

#include <array>
#include <span>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// How the cells' space diagonals lie.
enum class CellPattern {
  kuhn,      // all alike, from a cell's lowest corner to its highest
  mirrored,  // reflected along an axis in that axis's every second cell ("Union Jack")
};

// Where the cells of a box are small: at `finest` (m, in the box) and, alike, around it; from there
// they are ever longer, at last in geometric growth, and `ratio` (at least 1) times as long at the
// farthest end of an axis. With 1 all cells are alike, wherever `finest` is. More cells divide the
// same course of sizes: meshes of one grading are one family.
struct Grading {
  double ratio = 1.0;
  Vec3 finest = Vec3::Zero();
};

// A box with one corner in the origin and z upwards. `size` in m, each above 0; `cells` along x, y
// and z, each at least 1. Every cell becomes the six path tetrahedra 000 -> ... -> 111, one for
// each order of the axes (Kuhn 1960; Freudenthal 1942), so that neighbours share whole faces.
// Nodes are numbered x fastest, then y, then z. With `mirrored` and even counts the mesh is its
// own mirror image in the box's three middle planes; a graded one in those that hold `finest`.
// At every height of `levels` (m, rising, inside the box) cells end: the nearest border moves
// there. Throws MeshError where the tetrahedra cannot be counted in an int, and where there are
// fewer borders than levels.
[[nodiscard]] TetMesh cuboid(const Vec3& size, const std::array<int, 3>& cells, CellPattern pattern,
                             const Grading& grading = {}, std::span<const double> levels = {});

}  // namespace palpate::geometry
