// Any bytes as a surface file of the format FUZZ_TARGET (stl, obj, ply, off): what is read has
// triangles between its vertices.
#include <cmath>

#include "fuzzing.h"
#include "meshing/surface_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string path = fuzz::file("surface." FUZZ_TARGET, fuzz::text_of(data, size));
  fuzz::reads([&] {
    const geometry::Surface surface = meshing::read_surface(path, 1e-3);
    const int count = static_cast<int>(surface.vertices.size());
    fuzz::require(!surface.triangles.empty());
    for (const auto& vertex : surface.vertices) fuzz::require(vertex.allFinite());
    for (const auto& triangle : surface.triangles)
      for (const int corner : triangle) fuzz::require(corner >= 0 && corner < count);
  });
  return 0;
}
