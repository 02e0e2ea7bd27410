// Meshes in files: any kind read by its ending, TetGen's .node and .ele also written.
#pragma once

#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Reads a mesh from a .node and an .ele file that differ in their endings only; `path` names
// either. Coordinates are multiplied by `metres_per_unit`. Numbering from 0 or 1, as the first
// node has it; `#` starts a comment; nodes' attributes and markers are read over. Where tetrahedra
// have one attribute it is their region, a whole number; several are read over. Tetrahedra that
// are inside out are turned round, so all are positive or flat. Not checked beyond that: see
// mesh_check.h.
// Throws InputError with file and line for anything else than such files.
// Format: TetGen 1.5 manual, sections 5.2.1 and 5.2.4.
[[nodiscard]] TetMesh read_node_ele(const std::string& path, double metres_per_unit);

// Writes both files, numbered from 0, in metres, with the shortest digits that read back as the
// same bits, regions as an attribute where there are any; `path` names either. Each is written
// beside its place and then renamed. Throws InputError where `path` has another ending, SystemError
// where a file cannot be written.
void write_node_ele(const std::string& path, const TetMesh& mesh);

// Reads .node and .ele as above and Gmsh's .msh as in gmsh_file.h, whichever the ending says.
// Throws InputError for another ending too.
[[nodiscard]] TetMesh read_mesh(const std::string& path, double metres_per_unit);

}  // namespace palpate::geometry
