// Reads Gmsh's .msh files.
#pragma once

#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::meshing {

// Reads the tetrahedra with four nodes (element type 4) of a .msh file of version 2.2 or 4.1 in
// ASCII; points, lines and faces are ignored. Coordinates are multiplied by `metres_per_unit`. Only
// nodes of tetrahedra are kept, in the order of the file; their tags may have gaps. A tetrahedron's
// region is the absolute value of its physical tag, 0 without a tag; if no tetrahedron has a tag,
// `regions` is empty. Inverted tetrahedra are turned round. Nothing else is checked: see
// mesh_check.h. Throws InputError with file and line for anything else: binary files and other
// versions, other solid elements, partitioned meshes, volumes in several physical groups, and
// truncated files.
// Format: Gmsh 4.11 reference manual, sections 10.1 and 10.3.
[[nodiscard]] geometry::TetMesh read_gmsh(const std::string& path, double metres_per_unit);

}  // namespace palpate::meshing
