// Masses and springs from tetrahedra.
#include "tissue/network.h"

#include <utility>

namespace palpate::tissue {

std::vector<double> node_volumes(const geometry::TetMesh& mesh, std::span<const double> weight) {
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double quarter = 0.25 * geometry::signed_volume(mesh, static_cast<int>(t)) *
                           weight[static_cast<std::size_t>(mesh.region(static_cast<int>(t)))];
    for (const int node : mesh.tetrahedra[t]) volumes[static_cast<std::size_t>(node)] += quarter;
  }
  return volumes;
}

Network make_network(const geometry::TetMesh& mesh, std::span<const double> density,
                     std::vector<double> stiffness) {
  Network network;
  network.rest = mesh.nodes;
  network.node_mass = node_volumes(mesh, density);
  network.ends = geometry::edges(mesh);
  network.stiffness = std::move(stiffness);
  for (const auto& [a, b] : network.ends) {
    const Vec3 span =
        mesh.nodes[static_cast<std::size_t>(b)] - mesh.nodes[static_cast<std::size_t>(a)];
    network.rest_length.push_back(span.norm());
    network.direction.emplace_back(span / span.norm());
  }
  return network;
}

}  // namespace palpate::tissue
