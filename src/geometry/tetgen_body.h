// Tetrahedra for any body: one surface or several inside each other, about as many as asked for.
#pragma once

#include <span>

#include "geometry/shapes.h"

namespace palpate::geometry {

// How fine a mesh is wanted: by about its nodes, by them and its tetrahedra, or by its edges.
struct Target {
  int nodes = 0;             // 0: by the edge length
  int tetrahedra = 0;        // 0: as they come; else `nodes` is needed too
  double edge_length = 0.0;  // m, where `nodes` is 0
};

// The mesh of a body whose surfaces stay as they are: TetGen keeps every triangle and adds nodes
// inside only, so the surfaces set the fewest nodes that there can be. TetMesh::regions is the
// parts' `region`, or empty where that is 0 everywhere. `time_limit` in s, for all tries together.
// The same arguments give the same mesh, which check() has accepted.
// Throws MeshError as tetgen_surface() does; where a surface is not closed or inside out; where no
// mesh within 25 % of the target was found.
[[nodiscard]] TetMesh tetgen_body(const Body& body, const Target& target, double time_limit);

// The mesh of a shape with lumps in it: the sampling of the surfaces follows the target as well,
// so that the counts come within 3 % of most targets. Fewer tetrahedra for the same nodes mean a
// finer surface and a coarser inside.
[[nodiscard]] TetMesh tetgen_shape(const Shape& shape, std::span<const Lump> lumps,
                                   const Target& target, double time_limit);

}  // namespace palpate::geometry
