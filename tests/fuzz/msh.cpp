// Any text as a .msh file of Gmsh.
#include "mesh.h"
#include "meshing/gmsh_file.h"
#include "meshing/mesh_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string path = fuzz::file("mesh.msh", fuzz::text_of(data, size));
  fuzz::reads([&] {
    const geometry::TetMesh mesh = meshing::read_gmsh(path, 1e-3);
    fuzz::require_whole(mesh);
    meshing::check(mesh, path, 0.0);
  });
  return 0;
}
