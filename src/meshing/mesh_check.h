// Checks whether a mesh can be used for a simulation. Every mesh is checked, whatever its source.
#pragma once

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

}  // namespace palpate::meshing
