// Checks whether a surface can bound a body. Every surface is checked, whatever its source.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace palpate::meshing {

// Throws MeshError if the surface is not sound, with a sentence that names the first face, edge or
// vertex at fault (counting from 0), its position and a remedy. `name` is the name of the surface
// in messages.
//
// Refused, in this order: no faces; an index out of range; a coordinate that is not finite; a size
// (longest side of the bounding box) below 1e-6 m or above 10 m, probably a wrong unit; a face with
// a repeated vertex; two faces with the same vertices; a face whose height is below 1e-6 of its
// longest edge; a vertex without a face; the first face that is a third one at an edge, faces the
// side opposite to a neighbour's, or touches others in a vertex only; holes; more than one part,
// beside or inside each other; an inside-out surface; two faces that cut, touch or overlap each
// other. About 1 s for 1e5 faces.
void check_closed(const geometry::Surface& surface, const std::string& name);

}  // namespace palpate::meshing
