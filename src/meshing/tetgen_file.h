// The tetrahedral mesh of a surface from a file, whose triangles may be too fine or too long.
#pragma once

#include <span>
#include <string>

#include "geometry/body.h"
#include "meshing/tetgen_body.h"

namespace palpate::meshing {

struct FileMesh {
  geometry::TetMesh mesh;
  std::string remark;  // a sentence on a changed surface or number of nodes; or empty
};

// Meshes the body inside a surface that has passed check_closed(), with inclusions inside. A
// surface with as many vertices as nodes are asked for, or with edges below half of those asked
// for, is coarsened first, and one with needles is remeshed: see surface_remeshing.h. If there is
// still no mesh near the number of nodes, the mesh has the spacing of the surface. `time_limit` (s)
// is that of TetGen for each attempt. Throws MeshError as tetgen_body() and add_lump() do.
[[nodiscard]] FileMesh tetgen_file(geometry::Surface surface, std::span<const geometry::Lump> lumps,
                                   const Target& target, double time_limit);

}  // namespace palpate::meshing
