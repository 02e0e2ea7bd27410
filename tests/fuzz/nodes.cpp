// Any two texts, divided by a zero byte, as TetGen's .node and .ele.
#include "mesh.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string_view both = fuzz::text_of(data, size);
  const std::size_t end = both.find('\0');
  fuzz::file("mesh.node", both.substr(0, end));
  fuzz::file("mesh.ele", end == std::string_view::npos ? "" : both.substr(end + 1));
  fuzz::reads([] {
    const std::string path = (fuzz::folder() / "mesh.ele").string();
    const geometry::TetMesh mesh = meshing::read_node_ele(path, 1e-3);
    fuzz::require_whole(mesh);
    meshing::check(mesh, path, 0.0);
  });
  return 0;
}
