// Quality of a mesh: shapes of its tetrahedra, and the tetrahedron that limits an explicit step.
#pragma once

#include <array>

#include "geometry/tet_mesh.h"

namespace palpate::meshing {

// Angles in rad; a regular tetrahedron has six dihedral angles of 1.231 (70.53 degrees).
struct Quality {
  double smallest_angle = 0.0;  // dihedral
  double largest_angle = 0.0;
  std::array<int, 18> angles{};  // numbers of dihedral angles in each 10 degrees from 0 to 180
  double largest_edge_ratio =
      0.0;  // longest edge divided by shortest edge of a tetrahedron; regular: 1
  // 12 (3 V)^(2/3) divided by the sum of the squared edges (Liu & Joe 1994); regular: 1, flat: 0.
  double smallest_mean_ratio = 0.0;
  double smallest_volume = 0.0;  // m^3
  double largest_volume = 0.0;
  double shortest_edge = 0.0;  // m
  double longest_edge = 0.0;
  // A wave crosses a tetrahedron fastest along its shortest altitude, so that an explicit step is
  // at most about shortest_altitude / wave speed. The first such tetrahedron is the limiting one.
  double shortest_altitude = 0.0;  // m
  int limiting_tetrahedron = -1;
};

// Computes the quality of a mesh that check() accepts.
[[nodiscard]] Quality quality(const geometry::TetMesh& mesh);

}  // namespace palpate::meshing
