// How well shaped a mesh's tetrahedra are, and which of them limits an explicit step.
#pragma once

#include <array>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Angles in rad; a regular tetrahedron has six dihedral angles of 1.231 (70.53 degrees).
struct Quality {
  double smallest_angle = 0.0;  // dihedral
  double largest_angle = 0.0;
  std::array<int, 18> angles{};     // how many dihedral angles lie in each 10 degrees from 0 to 180
  double largest_edge_ratio = 0.0;  // longest over shortest edge of one tetrahedron; regular: 1
  // 12 (3 V)^(2/3) over the sum of the squared edges (Liu & Joe 1994); regular: 1, flat: 0.
  double smallest_mean_ratio = 0.0;
  double smallest_volume = 0.0;  // m^3
  double largest_volume = 0.0;
  double shortest_edge = 0.0;  // m
  double longest_edge = 0.0;
  // A wave crosses a tetrahedron soonest along its altitude, so an explicit step is at most about
  // shortest_altitude / wave speed: this tetrahedron, the first of several, sets it.
  double shortest_altitude = 0.0;  // m
  int limiting_tetrahedron = -1;
};

// Of a mesh that check() accepts.
[[nodiscard]] Quality quality(const TetMesh& mesh);

}  // namespace palpate::geometry
