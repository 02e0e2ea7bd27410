// A tetrahedral mesh, and its volumes, edges and boundary.
#pragma once

#include <array>
#include <vector>

#include "base/vec3.h"

namespace palpate::geometry {

// Indices count from 0. A tetrahedron (a, b, c, d) is positively oriented: seen from d, the
// nodes a, b, c run counter-clockwise, so that (b - a) x (c - a) . (d - a) > 0.
struct TetMesh {
  std::vector<Vec3> nodes;                     // m
  std::vector<std::array<int, 4>> tetrahedra;  // indices into `nodes`
  std::vector<int> regions = {};               // one per tetrahedron; empty: all are 0

  // The region of a tetrahedron, which selects its tissue.
  [[nodiscard]] int region(int tetrahedron) const {
    return regions.empty() ? 0 : regions[as_index(tetrahedron)];
  }
};

// The four faces of a positively oriented tetrahedron as local node numbers, counter-clockwise from
// outside; face i is opposite to node i.
inline constexpr std::array<std::array<int, 3>, 4> outward_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// The six edges of a tetrahedron as local node numbers.
inline constexpr std::array<std::array<int, 2>, 6> corner_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// A face of one tetrahedron.
struct FaceUse {
  std::array<int, 3>
      key{};  // the nodes, ascending: equal for the two tetrahedra that share the face
  std::array<int, 3> nodes{};  // the same nodes, oriented outwards from `tetrahedron`
  int tetrahedron = 0;
};

// V = (b - a) x (c - a) . (d - a) / 6, m^3; negative for an inverted tetrahedron.
[[nodiscard]] double signed_volume(const TetMesh& mesh, int tetrahedron);

// The sum of the signed volumes in index order, m^3.
[[nodiscard]] double volume(const TetMesh& mesh);

// The diagonal of the bounding box, m, the reference of all relative tolerances; 0 without nodes.
[[nodiscard]] double diagonal(const TetMesh& mesh);

// Every edge once as (i, j) with i < j, in ascending order.
[[nodiscard]] std::vector<std::array<int, 2>> edges(const TetMesh& mesh);

// The four faces of every tetrahedron, sorted by `key` and then by tetrahedron.
[[nodiscard]] std::vector<FaceUse> face_uses(const TetMesh& mesh);

// The faces that belong to a single tetrahedron, counter-clockwise from outside, in the order of
// the tetrahedra and within one in the order of outward_faces.
[[nodiscard]] std::vector<std::array<int, 3>> boundary_faces(const TetMesh& mesh);

// The nodes in the plane at height `z` (m), ascending; tolerance 1e-9 of the mesh's diagonal.
[[nodiscard]] std::vector<int> nodes_at_height(const TetMesh& mesh, double z);

}  // namespace palpate::geometry
