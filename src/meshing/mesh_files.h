// Reads mesh files of every supported format, and writes TetGen's .node and .ele.
#pragma once

#include <string>

#include "geometry/tet_mesh.h"
#include "meshing/cells.h"

namespace palpate::meshing {

// Reads a mesh from a .node and an .ele file whose names differ only in the ending; `path` names
// either. Coordinates are multiplied by `metres_per_unit`. The first node has the number 0 or 1;
// `#` starts a comment; attributes and markers of nodes are ignored. A single attribute of
// tetrahedra is their region, a whole number; several attributes are ignored. Inverted tetrahedra
// are turned round. Nothing else is checked: see mesh_check.h. Throws InputError with file and line
// for files of another form.
// Format: TetGen 1.5 manual, sections 5.2.1 and 5.2.4.
[[nodiscard]] geometry::TetMesh read_node_ele(const std::string& path, double metres_per_unit);

// Writes both files, numbered from 0, in metres, with the shortest digits that read back to the
// same bits; regions, if there are any, become an attribute. `path` names either file. Each file is
// written beside its place and then renamed. Throws InputError if `path` has another ending,
// SystemError if a file cannot be written.
void write_node_ele(const std::string& path, const geometry::TetMesh& mesh);

// Whether both files exist and are what write_node_ele() would write. `path` names either file.
[[nodiscard]] bool holds_node_ele(const std::string& path, const geometry::TetMesh& mesh);

// Reads .node and .ele as above, or a file of cells (see cells.h), as the ending says. Throws
// InputError for another ending too.
[[nodiscard]] NamedMesh read_mesh(const std::string& path, double metres_per_unit);

}  // namespace palpate::meshing
