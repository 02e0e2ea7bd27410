// Any bytes as a surface file of a format (stl, obj, ply, off): what is read has
// triangles between its vertices.
#include <cmath>

#include "fuzzing.h"
#include "meshing/surface_files.h"

void palpate::fuzz::surface(const char* format, const std::uint8_t* data, std::size_t size) {
  const std::string path = file(std::string("surface.") + format, text_of(data, size));
  reads([&] {
    const geometry::Surface surface = meshing::read_surface(path, 1e-3);
    const int count = static_cast<int>(surface.vertices.size());
    require(!surface.triangles.empty());
    for (const auto& vertex : surface.vertices) require(vertex.allFinite());
    for (const auto& triangle : surface.triangles)
      for (const int corner : triangle) require(corner >= 0 && corner < count);
  });
}
