// Readers of surface files: the polygons of a file, checked line by line or record by record.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {

struct Polygons {
  std::vector<Vec3> vertices;             // in the file's unit
  std::vector<std::vector<int>> corners;  // of each face, counting from 0
};

// Each function reads a file. Every face then has three corners or more, which are different
// vertices of the list; the corners of an STL's facets are vertices of their own, in different
// places. All coordinates are finite. They throw InputError if the file cannot be read; MeshError,
// with file, line or record and a remedy, if it is truncated, a number is malformed or a count is
// wrong.
[[nodiscard]] Polygons read_obj(const std::string& path);
[[nodiscard]] Polygons read_off(const std::string& path);
[[nodiscard]] Polygons read_stl(const std::string& path);
[[nodiscard]] Polygons read_ply(const std::string& path);

// Throws MeshError for the file at `path`.
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

}  // namespace palpate::meshing
