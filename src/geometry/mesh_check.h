// Is this mesh fit for a simulation? Asked of every mesh, whoever made it.
#pragma once

#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Returns where the mesh is sound; else throws MeshError with one sentence that names the first
// tetrahedron, node or face at fault (all counting from 0) and a remedy. `name` is how messages
// call the mesh. `expected_volume` in m^3; 0 or less means unknown.
//
// Refused, in this order: no tetrahedra; a node index out of range; a node that is not finite; a
// tetrahedron with a repeated node; a tetrahedron that is inside out or flatter than 1e-9 of its
// longest edge cubed; a node that no tetrahedron uses; a face of more than two tetrahedra, or of
// two on the same side; a boundary edge without exactly two boundary faces; a volume that differs
// from the expected one by more than 1e-6 of it. Every tolerance scales with the mesh.
void check(const TetMesh& mesh, const std::string& name, double expected_volume);

}  // namespace palpate::geometry
