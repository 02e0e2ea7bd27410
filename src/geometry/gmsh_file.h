// Gmsh's .msh files, read.
#pragma once

#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Reads the tetrahedra with four nodes (element type 4) of a .msh file of version 2.2 or 4.1 in
// ASCII; points, lines and faces are read over. Coordinates are multiplied by `metres_per_unit`.
// Only nodes that a tetrahedron uses are kept, in the order of the file; their tags may have gaps.
// A tetrahedron's region is its physical tag as it stands in the file, 0 without one; where no
// tetrahedron has one, `regions` is empty. Tetrahedra that are inside out are turned round. Not
// checked beyond that: see mesh_check.h.
// Throws InputError with file and line for anything else: binary files and other versions, other
// solid elements, partitioned meshes, volumes in two physical groups, and files that break off.
// Format: Gmsh 4.11 reference manual, sections 10.1 and 10.3.
[[nodiscard]] TetMesh read_gmsh(const std::string& path, double metres_per_unit);

}  // namespace palpate::geometry
