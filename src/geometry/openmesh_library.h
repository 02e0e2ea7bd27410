// OpenMesh's readers, which believe whatever they are given; only surface_files.cpp calls this.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::geometry::openmesh_library {

struct Polygons {
  std::vector<Vec3> vertices;  // in the file's unit, rounded to single precision by OpenMesh
  std::vector<std::vector<int>> corners;  // one list a face, counting from 0; not checked
  bool good = false;                      // OpenMesh's own opinion
};

// Reads a file's content. `format` is "stl", "obj", "ply" or "off". OpenMesh prints, keeps state in
// its readers and follows the global locale: call this in a child process.
[[nodiscard]] Polygons run(const std::string& content, const std::string& format, bool binary);

}  // namespace palpate::geometry::openmesh_library
