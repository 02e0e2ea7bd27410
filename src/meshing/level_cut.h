// Meshes whose nodes include a plane of equal height.
#pragma once

#include <optional>

#include "geometry/shapes.h"

namespace palpate::meshing {

// The mesh with no edge across the plane at height z (m), or no edge of its boundary. A node that
// is nearer to the plane than a quarter of an edge that crosses it is moved there along that edge,
// if that leaves the boundary's creases and the borders of regions where they are and turns nothing
// inside out; the other edges are split. New nodes on the boundary are on `shape`, or on the smooth
// surface through the mesh's nodes without one.
[[nodiscard]] geometry::TetMesh cut_at(geometry::TetMesh mesh, double z, bool outer_only,
                                       const std::optional<geometry::Shape>& shape);

}  // namespace palpate::meshing
