// Reads surfaces from files of other programs: STL, OBJ, PLY and OFF.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "geometry/surface.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {

struct Polygons {
  std::vector<Vec3> vertices;             // in the file's unit
  std::vector<std::vector<int>> corners;  // of each face, counting from 0
};

// Each function reads a file. Every face then has three corners or more, which are vertices of the
// list, some perhaps twice; the corners of an STL's facets are vertices of their own. All
// coordinates are finite. They throw InputError, with line or record where possible, if the file
// cannot be read, is truncated, a number is malformed or a count is wrong.
[[nodiscard]] Polygons read_obj(const std::string& path);
[[nodiscard]] Polygons read_off(const std::string& path);
[[nodiscard]] Polygons read_stl(const std::string& path);
[[nodiscard]] Polygons read_ply(const std::string& path);

// Throws InputError for the file at `path`.
[[noreturn]] void fail(const std::string& path, const std::string& message);

// Whether the bytes may be the text of a mesh: no control characters, no word longer than 200.
[[nodiscard]] bool is_text(const std::string& content);

// Throws InputError if there is a comma between the line's first and last word: TableLines
// separates words there, so that a decimal comma would give two numbers.
void no_comma(const TableLines& lines);

// What is wrong with the corners of `face`, which count from `first`, among so many vertices; empty
// if nothing is.
[[nodiscard]] std::string wrong_corners(const std::string& face, const std::vector<int>& corners,
                                        int first, std::size_t vertices);

// The message on a line with so many corners.
[[nodiscard]] std::string too_few_corners(std::size_t corners);

// Reads a surface in the format given by the file's ending: .stl (ASCII or binary), .obj, .ply
// (ASCII or binary of either byte order) or .off (ASCII), in upper or lower case; or the faces of a
// file of cells (see cells.h) that has no solids. Coordinates are
// read in double precision and multiplied by `metres_per_unit`. Vertices with equal
// coordinates are merged, in the order in which the faces first name them; vertices without a face
// are dropped. Polygons are cut into triangles from one corner; triangles keep the order of the
// file's faces. Normals, colours, texture and groups are ignored. Nothing is printed, and the
// locale has no effect. The surface itself is not checked: see surface_repair.h.
// Throws InputError if the file does not exist or has another ending, and as read_off() does.
[[nodiscard]] geometry::Surface read_surface(const std::string& path, double metres_per_unit);

// Writes a surface as .off or binary .stl, as the ending says, whole or not at all; coordinates are
// divided by `metres_per_unit`. Throws InputError for another ending, SystemError if it cannot.
void write_surface(const std::string& path, const geometry::Surface& surface,
                   double metres_per_unit);

}  // namespace palpate::meshing
