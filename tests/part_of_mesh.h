// Bodies that are parts of a lattice.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "base/index.h"
#include "geometry/tet_mesh.h"

namespace palpate::test {

// The tetrahedra whose middle (m) is kept, with their nodes alone.
inline geometry::TetMesh part_of(const geometry::TetMesh& mesh,
                                 const std::function<bool(const Vec3&)>& kept) {
  geometry::TetMesh part;
  std::vector<int> number(mesh.nodes.size(), -1);
  for (auto corners : mesh.tetrahedra) {
    Vec3 middle = Vec3::Zero();
    for (const int node : corners) middle += 0.25 * mesh.nodes[as_index(node)];
    if (!kept(middle)) continue;
    for (int& node : corners) {
      int& own = number[as_index(node)];
      if (own < 0) {
        own = static_cast<int>(part.nodes.size());
        part.nodes.push_back(mesh.nodes[as_index(node)]);
      }
      node = own;
    }
    part.tetrahedra.push_back(corners);
  }
  return part;
}

}  // namespace palpate::test
