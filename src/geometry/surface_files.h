// Surfaces from files of other programs: STL, OBJ, PLY and OFF.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace palpate::geometry {

// Reads a surface by its file's ending: .stl (ASCII or binary), .obj, .ply (ASCII or binary of
// either byte order) or .off (ASCII), in any case. Coordinates keep single precision and are then
// multiplied by `metres_per_unit`. Vertices in exactly one place become one, in the order in which
// the faces name them first; vertices without a face are left out. Polygons are cut into triangles
// from one corner; triangles keep the order of the file's faces. Normals, colours, texture and
// groups are read over. Nothing is printed, and the locale does not matter. Not checked beyond
// the file itself: see surface_check.h.
// Throws InputError where there is no such file, it cannot be read or has another ending;
// MeshError, with file and where possible line and a remedy, for everything that is wrong inside.
[[nodiscard]] Surface read_surface(const std::string& path, double metres_per_unit);

}  // namespace palpate::geometry
