// Edges of quadratic cells, which are parabolas through a node in their middle, and their halves.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// The places (m) of the middles of curved edges, by their ends, ascending.
using EdgeMiddles = std::map<std::array<int, 2>, Vec3>;

// Splits edges in their middles, so that the parts of every face are on the quadratic surface
// through its six nodes.
class CurvedEdges {
 public:
  // Edges that are not in `middles` are straight.
  CurvedEdges(std::vector<Vec3> nodes, EdgeMiddles middles);

  // Between two nodes that an edge joins: an edge of the mesh, a half of one, or one that divides a
  // triangle whose opposite edge was split. m.
  [[nodiscard]] Vec3 middle(int a, int b) const;
  // Adds the node in the middle of an edge, with the next number; returns its place.
  Vec3 split(int a, int b);

  [[nodiscard]] const std::vector<Vec3>& nodes() const { return nodes_; }

 private:
  std::vector<Vec3> nodes_;
  EdgeMiddles middles_;
  int given_;                                // nodes of the mesh
  std::vector<std::array<int, 2>> parents_;  // of the nodes after these: the ends of their edges
};

// The boundary of a mesh of quadratic tetrahedra: every face becomes triangles through its six
// nodes, and these again while parts of an edge meet at more than 25 degrees, up to 64 of a face.
// Without curved edges that of outer_surface().
[[nodiscard]] Surface curved_boundary(const TetMesh& mesh, const EdgeMiddles& middles);

}  // namespace palpate::geometry
