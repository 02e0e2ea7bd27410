// Is this surface fit to bound a body? Asked of every surface, whoever made it.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace palpate::geometry {

// Each returns where the surface is sound; else throws MeshError with one sentence that names the
// first face, edge or vertex at fault (counting from 0), where it lies, and a remedy. `name` is how
// messages call the surface.
//
// Refused, in this order: no faces; an index out of range; a coordinate that is not finite; a size
// (longest side of the bounding box) below 1e-6 m or above 10 m, where a wrong unit is the likely
// reason; a face with a repeated vertex; two faces with the same vertices; a face whose height is
// below 1e-6 of its longest edge; a vertex without a face; an edge of more than two faces; two
// neighbours that face opposite sides; holes; more than one part, beside or inside each other; a
// vertex where parts of the surface touch in a point only; a surface that is inside out as a whole;
// two faces that cut, touch or overlap each other. About 1 s for 1e5 faces.
void check_closed(const Surface& surface, const std::string& name);

// The same for a surface that may have holes, such as a fingertip that ends at its base. It has no
// inside, so that inside out is not asked.
void check_open(const Surface& surface, const std::string& name);

}  // namespace palpate::geometry
