// Checks whether a mesh can be used for a simulation. Every mesh is checked, whatever its source.
#pragma once

#include <array>
#include <span>
#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::meshing {

// Throws MeshError if the mesh is not sound, with a sentence that names the first tetrahedron, node
// or face at fault (all counting from 0) and a remedy. `name` is the name of the mesh in messages.
// `expected_volume` in m^3; 0 or less means unknown.
//
// Refused, in this order: no tetrahedra; a node index out of range; a node that is not finite; a
// tetrahedron with a repeated node; a tetrahedron that is inverted, or flat (a volume below 1e-9 of
// its longest edge cubed); a node without tetrahedra; a face of more than two tetrahedra, or of two
// on the same side; an edge or a node at which parts of the boundary only touch; a volume that
// differs from the expected one by more than 1e-6 of it. Every tolerance scales with the mesh.
void check(const geometry::TetMesh& mesh, const std::string& name, double expected_volume);

// Throws KeyError if the longest side of the box of these places is below 1e-6 m or above 10 m,
// with the unit that is probably meant. `name` stands in messages as it is; `unit` is that in which
// the coordinates were read, and `key` the scenario's key for it.
void refuse_size(std::span<const Vec3> places, const std::string& name, const std::string& unit,
                 const std::string& key);

// The units with which a body of `size` (m), read in `unit`, would have 5 mm to 2 m, of what is
// usually pressed: "in `cm` it would be 0.23 m long, in `mm` 0.023 m"; empty if there is none.
[[nodiscard]] std::string other_units(double size, const std::string& unit);

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
