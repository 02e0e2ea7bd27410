// Any bytes as a file of cells of a format (msh, vtk, vtu, inp, mesh).
#include "mesh.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"

void palpate::fuzz::cells(const char* format, const std::uint8_t* data, std::size_t size) {
  const std::string path = file(std::string("mesh.") + format, text_of(data, size));
  reads([&] {
    const geometry::TetMesh mesh = meshing::read_mesh(path, 1e-3).mesh;
    require_whole(mesh);
    meshing::check(mesh, path, 0.0);
  });
}
