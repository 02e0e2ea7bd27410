// Any two texts, divided by a zero byte, as TetGen's .node and .ele.
#include "mesh.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"

void palpate::fuzz::nodes(const std::uint8_t* data, std::size_t size) {
  const std::string_view both = text_of(data, size);
  const std::size_t end = both.find('\0');
  file("mesh.node", both.substr(0, end));
  file("mesh.ele", end == std::string_view::npos ? "" : both.substr(end + 1));
  reads([] {
    const std::string path = (folder() / "mesh.ele").string();
    const geometry::TetMesh mesh = meshing::read_node_ele(path, 1e-3);
    require_whole(mesh);
    meshing::check(mesh, path, 0.0);
  });
}
