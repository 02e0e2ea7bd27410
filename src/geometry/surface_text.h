// What a surface file declares, counted before OpenMesh sees it.
#pragma once

#include <cstddef>
#include <string>

#include "geometry/table_lines.h"

namespace palpate::geometry {

// OpenMesh skips what it does not understand and reports success. So every file is gone over first:
// each line (or record) that must count is looked at, and `content` holds what OpenMesh is to read.
struct SurfaceText {
  std::string content;
  bool binary = false;
  std::size_t vertices = 0;  // 0 for STL, which repeats them
  std::size_t faces = 0;
};

// Each reads the file and throws InputError where it cannot be read, MeshError with file, line and
// a remedy where it is cut short, has a number that is none, or a count that does not hold.
[[nodiscard]] SurfaceText go_over_obj(const std::string& path);
[[nodiscard]] SurfaceText go_over_off(const std::string& path);
[[nodiscard]] SurfaceText go_over_stl(const std::string& path);
[[nodiscard]] SurfaceText go_over_ply(const std::string& path);

// Whether these bytes can be the text of a mesh: no control characters, no word longer than 200.
[[nodiscard]] bool is_text(const std::string& content);

// Refuses a comma between the line's first and last word: TableLines parts words there, so that the
// decimal comma of another country would give two numbers. Throws InputError.
void no_comma(const TableLines& lines);

}  // namespace palpate::geometry
