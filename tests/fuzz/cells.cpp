// Any bytes as a file of cells of the format FUZZ_TARGET (msh, vtk, vtu, inp, mesh).
#include "mesh.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string path = fuzz::file("mesh." FUZZ_TARGET, fuzz::text_of(data, size));
  fuzz::reads([&] {
    const geometry::TetMesh mesh = meshing::read_mesh(path, 1e-3).mesh;
    fuzz::require_whole(mesh);
    meshing::check(mesh, path, 0.0);
  });
  return 0;
}
