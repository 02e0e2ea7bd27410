// Masses and springs from tetrahedra.
#include "tissue/network.h"

#include <utility>

namespace palpate::tissue {

std::vector<double> node_volumes(const geometry::TetMesh& mesh, std::span<const double> weight) {
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double quarter = 0.25 * geometry::signed_volume(mesh, static_cast<int>(t)) *
                           weight[as_index(mesh.region(static_cast<int>(t)))];
    for (const int node : mesh.tetrahedra[t]) volumes[as_index(node)] += quarter;
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
    const Vec3 span = mesh.nodes[as_index(b)] - mesh.nodes[as_index(a)];
    network.rest_length.push_back(span.norm());
    network.direction.emplace_back(span / span.norm());
  }
  return network;
}

}  // namespace palpate::tissue
