// Reads surfaces from files of other programs: STL, OBJ, PLY and OFF.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace palpate::meshing {

// Reads a surface in the format given by the file's ending: .stl (ASCII or binary), .obj, .ply
// (ASCII or binary of either byte order) or .off (ASCII), in upper or lower case; or the faces of a
// file of cells (see cells.h) that has no solids. Coordinates are
// read in double precision and multiplied by `metres_per_unit`. Vertices with equal
// coordinates are merged, in the order in which the faces first name them; vertices without a face
// are dropped. Polygons are cut into triangles from one corner; triangles keep the order of the
// file's faces. Normals, colours, texture and groups are ignored. Nothing is printed, and the
// locale has no effect. The surface itself is not checked: see surface_check.h.
// Throws InputError if the file does not exist, cannot be read or has another ending; MeshError,
// with file, line where possible, and a remedy, for all mistakes in its content.
[[nodiscard]] geometry::Surface read_surface(const std::string& path, double metres_per_unit);

// Writes a surface as .off or binary .stl, as the ending says, whole or not at all; coordinates are
// divided by `metres_per_unit`. Throws InputError for another ending, SystemError if it cannot.
void write_surface(const std::string& path, const geometry::Surface& surface,
                   double metres_per_unit);

}  // namespace palpate::meshing
