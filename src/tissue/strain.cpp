// Strain from the three edges of a tetrahedron at its first node, and from their displacements.
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
    const auto first = as_index(corners[0]);
    Eigen::Matrix3d edges, changes;
    for (int i = 0; i < 3; ++i) {
      const auto other = as_index(corners[as_index(i) + 1]);
      edges.col(i) = mesh.nodes[other] - mesh.nodes[first];
      changes.col(i) = displacement[other] - displacement[first];
    }
    // H X = U for the edges X and their changes U.
    const Eigen::Matrix3d gradient = changes * edges.inverse();
    strains.push_back(
        {gradient(0, 0), gradient(1, 1), gradient(2, 2), 0.5 * (gradient(0, 1) + gradient(1, 0)),
         0.5 * (gradient(1, 2) + gradient(2, 1)), 0.5 * (gradient(0, 2) + gradient(2, 0))});
  }
  return strains;
}

}  // namespace palpate::tissue
