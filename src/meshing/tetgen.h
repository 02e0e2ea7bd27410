// Tetrahedral meshes by TetGen, which runs in a child process.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "geometry/surface.h"

namespace palpate::meshing {

// TetGen has found no mesh: the surface is to blame.
struct TetgenError : MeshError {
  using MeshError::MeshError;
};

// Runs TetGen 1.5 on a closed surface. `switches` are those of TetGen's manual, section 4.2, with
// `p` and without `Q`, such as "pq1.414a1e-9" (lengths in m); `time_limit` in s, above 0. The
// tetrahedra have positive volumes; nothing else is checked (see mesh_check.h). There may be
// further surfaces inside; with `A`, TetGen numbers the regions between the surfaces from 1.
//
// TetGen 1.5 has global data for its predicates (two threads would silently damage each other's
// mesh), writes to stdout and may crash. It therefore runs in a forked child: any number of threads
// may call this at once, and each gets the same bits as alone.
// Throws TetgenError, with advice, if TetGen refuses the surface, crashes, exceeds time or memory,
// or finds no interior; SystemError if no child process can be started.
[[nodiscard]] geometry::TetMesh tetgen_surface(const geometry::Surface& surface,
                                               const std::string& switches, double time_limit);

// A closed body in pieces: triangles with a number each, which may meet in any way along edges.
struct Pieces {
  geometry::Surface surface;
  std::vector<int> numbers;  // one per triangle, above 0
};
// The mesh of pieces, with the faces that lie on them.
struct PieceMesh {
  geometry::TetMesh mesh;                 // its first nodes are the vertices of the pieces
  std::vector<std::array<int, 3>> faces;  // corners, in no particular direction
  std::vector<int> numbers;               // of the pieces, one per face
};
// Tetrahedra with edges of about size(place) (m) in the body; faces are split as well. Throws as
// tetgen_surface() does.
[[nodiscard]] PieceMesh tetgen_pieces(const Pieces& pieces,
                                      const std::function<double(const Vec3&)>& size,
                                      double time_limit);

// The numbers that `A` gave to the parts between surfaces become those that `region_at` has for a
// place in each; parts for which it has none are cavities, and removed. Returns the new numbers of
// the nodes, -1 for those inside cavities.
std::vector<int> name_regions(geometry::TetMesh& mesh,
                              const std::function<std::optional<int>(const Vec3&)>& region_at);

// A box from the origin to `size` (m), with about `target_nodes` nodes: within 3 % for most targets
// of 60 or more. Its surface is a grid of squares cut in two, with spacings of about the edge
// length inside. `time_limit` in s, for all attempts together. The same arguments give the same
// mesh. Throws like tetgen_surface(), and MeshError for fewer than the 8 nodes of a box or if no
// mesh within 25 % of the target is found.
[[nodiscard]] geometry::TetMesh tetgen_cuboid(const Vec3& size, int target_nodes,
                                              double time_limit);

}  // namespace palpate::meshing
