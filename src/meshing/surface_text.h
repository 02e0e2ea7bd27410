// Checks surface files and counts their vertices and faces before OpenMesh reads them.
#pragma once

#include <cstddef>
#include <string>

#include "meshing/table_lines.h"

namespace palpate::meshing {

// OpenMesh skips everything that it does not understand and reports success. Therefore each line
// (or record) that matters is checked first; `content` is what OpenMesh then reads.
struct SurfaceText {
  std::string content;
  bool binary = false;
  std::size_t vertices = 0;  // 0 for STL, which repeats vertices
  std::size_t faces = 0;
};

// Each function reads a file. It throws InputError if the file cannot be read; MeshError, with
// file, line and a remedy, if the file is truncated, a number is malformed or a count is wrong.
[[nodiscard]] SurfaceText go_over_obj(const std::string& path);
[[nodiscard]] SurfaceText go_over_off(const std::string& path);
[[nodiscard]] SurfaceText go_over_stl(const std::string& path);
[[nodiscard]] SurfaceText go_over_ply(const std::string& path);

// Throws MeshError for the file at `path`.
[[noreturn]] void fail(const std::string& path, const std::string& message);

// Whether the bytes may be the text of a mesh: no control characters, no word longer than 200.
[[nodiscard]] bool is_text(const std::string& content);

// Throws InputError if there is a comma between the line's first and last word: TableLines
// separates words there, so that a decimal comma would give two numbers.
void no_comma(const TableLines& lines);

}  // namespace palpate::meshing
