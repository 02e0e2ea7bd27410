// Irregular tetrahedra by TetGen, in a process of its own.
#pragma once

#include <string>

#include "geometry/surface.h"

namespace palpate::geometry {

// Runs TetGen 1.5 on a closed surface. `switches` as in TetGen's manual, section 4.2, without `Q`
// and with `p`, such as "pq1.414a1e-9" (lengths in m); `time_limit` in s, more than 0. The mesh
// comes back with positive tetrahedra; it is not checked (see mesh_check.h). The surface may have
// further ones inside; with `A` the tetrahedra's regions are then numbers, from 1, that TetGen
// gives to the parts which the surfaces separate.
//
// TetGen 1.5 keeps its predicates' filters in globals (two threads silently spoil each other's
// mesh), writes to stdout and may crash. So it runs in a forked child: any number of threads may
// call this at once, and each gets the bits that it would get alone.
// Throws MeshError, with advice, where TetGen refuses, crashes, runs out of time or memory or
// finds nothing; SystemError where no child process can be had.
[[nodiscard]] TetMesh tetgen_surface(const Surface& surface, const std::string& switches,
                                     double time_limit);

// A box with one corner in the origin, z upwards, `size` in m, with about `target_nodes` nodes:
// within 3 % for most targets from 60 upwards. Its surface is a grid of squares cut in two, whose
// spacing is about the edge length inside. `time_limit` in s, for all tries together.
// The same arguments give the same mesh.
// Throws as tetgen_surface() does, and MeshError for fewer than the 8 nodes of a box or where no
// mesh within 25 % of the target was found.
[[nodiscard]] TetMesh tetgen_cuboid(const Vec3& size, int target_nodes, double time_limit);

}  // namespace palpate::geometry
