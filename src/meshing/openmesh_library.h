// OpenMesh's readers, which do not check their input; only surface_files.cpp calls this.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::meshing::openmesh_library {

struct Polygons {
  std::vector<Vec3> vertices;  // in the file's unit, rounded to single precision by OpenMesh
  std::vector<std::vector<int>> corners;  // one list per face, counting from 0; not checked
  bool good = false;                      // OpenMesh reported success
};

// Reads a file's content. `format` is "stl", "obj", "ply" or "off". OpenMesh prints, has global
// state in its readers, and depends on the global locale: call this in a child process only.
[[nodiscard]] Polygons run(const std::string& content, const std::string& format, bool binary);

}  // namespace palpate::meshing::openmesh_library
