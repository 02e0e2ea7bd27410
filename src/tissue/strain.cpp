// A tetrahedron's three edges from its first node, at rest and in their displacement.
#include "tissue/strain.h"

#include <Eigen/LU>
#include <cassert>

namespace palpate::tissue {

std::vector<Strain> small_strain(const geometry::TetMesh& mesh,
                                 std::span<const Vec3> displacement) {
  assert(displacement.size() == mesh.nodes.size());
  std::vector<Strain> strains;
  strains.reserve(mesh.tetrahedra.size());
  for (const auto& corners : mesh.tetrahedra) {
    const auto first = static_cast<std::size_t>(corners[0]);
    Eigen::Matrix3d edges, changes;
    for (int i = 0; i < 3; ++i) {
      const auto other = static_cast<std::size_t>(corners[static_cast<std::size_t>(i) + 1]);
      edges.col(i) = mesh.nodes[other] - mesh.nodes[first];
      changes.col(i) = displacement[other] - displacement[first];
    }
    // H X = U for the edges X and their changes U
    const Eigen::Matrix3d gradient = changes * edges.inverse();
    strains.push_back(
        {gradient(0, 0), gradient(1, 1), gradient(2, 2), 0.5 * (gradient(0, 1) + gradient(1, 0)),
         0.5 * (gradient(1, 2) + gradient(2, 1)), 0.5 * (gradient(0, 2) + gradient(2, 0))});
  }
  return strains;
}

}  // namespace palpate::tissue
