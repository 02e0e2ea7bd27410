// Tetrahedral meshes of any body (one surface, or several inside each other) of a requested size.
#pragma once

#include <span>
#include <string>

#include "base/error.h"
#include "geometry/body.h"
#include "geometry/shapes.h"

namespace palpate::meshing {

// Requested size of a mesh: number of nodes, numbers of nodes and tetrahedra, or edge length.
struct Target {
  int nodes = 0;             // 0: `edge_length` is used
  int tetrahedra = 0;        // 0: any number; otherwise `nodes` is needed too
  double edge_length = 0.0;  // m, used if `nodes` is 0
};

// The surfaces have more nodes than the mesh may have.
struct TooFewNodes : MeshError {
  TooFewNodes(const std::string& text, int on_surfaces) : MeshError(text), least(on_surfaces) {}
  int least;
};

// The meshes that were found have more or fewer nodes than the mesh may have.
struct OtherNodes : MeshError {
  using MeshError::MeshError;
};

// The surface has needles that even triangles cannot replace, and TetGen makes no mesh with them,
// whatever its size.
struct Needles : MeshError {
  using MeshError::MeshError;
};

// The mesh of a body. TetGen keeps every triangle of the surfaces and adds nodes inside only, so
// the surfaces determine the smallest number of nodes; if that leaves too few nodes or triangles
// that are too coarse, TetGen may split triangles. TetMesh::regions are the parts' `region`, or
// empty if all are 0. `time_limit` in s, for all attempts together. The same arguments give the
// same mesh. check() has accepted it. Throws MeshError as tetgen_surface() does, if a surface is
// not closed or inside out, and if no mesh within 25 % of the target is found, as TooFewNodes or
// OtherNodes where that is why.
[[nodiscard]] geometry::TetMesh tetgen_body(const geometry::Body& body, const Target& target,
                                            double time_limit);

// The mesh of a shape with inclusions. The sampling of the surfaces is also adapted to the target,
// so that the counts are within 3 % for most targets. Fewer tetrahedra with the same number of
// nodes mean a finer surface and a coarser interior.
[[nodiscard]] geometry::TetMesh tetgen_shape(const geometry::Shape& shape,
                                             std::span<const geometry::Inclusion> inclusions,
                                             const Target& target, double time_limit);

struct FileMesh {
  geometry::TetMesh mesh;
  std::string warning;  // a sentence on a changed surface or number of nodes; or empty
};

// Meshes the body inside a surface that has passed check_closed(), with inclusions inside. A
// surface with as many vertices as nodes are asked for, or with edges below half of those asked
// for, is coarsened first, and one with needles is remeshed: see surface_remeshing.h. Edges of
// walls that are too thin for nodes inside are halved. If there is still no mesh near the number of
// nodes, the mesh has the spacing of the surface. `time_limit` (s) is that of TetGen for each
// attempt, which is shorter with needles. Throws MeshError as tetgen_body() and add_inclusion() do,
// and Needles.
[[nodiscard]] FileMesh tetgen_file(geometry::Surface surface,
                                   std::span<const geometry::Inclusion> inclusions,
                                   const Target& target, double time_limit);

}  // namespace palpate::meshing
