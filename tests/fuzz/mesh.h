// What every mesh that was read from a file promises.
#pragma once

#include "fuzzing.h"
#include "geometry/tet_mesh.h"

namespace palpate::fuzz {

inline void require_whole(const geometry::TetMesh& mesh) {
  const int count = static_cast<int>(mesh.nodes.size());
  require(!mesh.tetrahedra.empty());
  require(mesh.regions.empty() || mesh.regions.size() == mesh.tetrahedra.size());
  for (const auto& node : mesh.nodes) require(node.allFinite());
  for (const auto& tetrahedron : mesh.tetrahedra)
    for (const int corner : tetrahedron) require(corner >= 0 && corner < count);
}

}  // namespace palpate::fuzz
