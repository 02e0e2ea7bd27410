// Surfaces as scans have them: small faults are mended and told, larger ones refused.
#pragma once

#include <optional>
#include <string>

#include "geometry/surface.h"

namespace palpate::meshing {

// Throws MeshError if the surface is not sound, with a sentence that names the first face, edge or
// vertex at fault (counting from 0), its position and a remedy. `name` is the name of the surface
// in messages.
//
// Refused, in this order: no faces; an index out of range; a coordinate that is not finite; a face
// with a repeated vertex; two faces with the same vertices; a face whose height is below 1e-6 of
// its longest edge; a vertex without a face; the first face that is a third one at an edge, faces
// the side opposite to a neighbour's, or touches others in a vertex only; holes; an inside-out
// surface; a part beside another, or inside another and facing outwards (one that faces inwards is
// a cavity); two faces that cut, touch or overlap each other. About 1 s for 1e5 faces.
void check_closed(const geometry::Surface& surface, const std::string& name);

struct WholeSurface {
  geometry::Surface surface;  // has passed check_closed()
  std::string warning;        // what was changed, with places and sizes; empty if nothing was
  std::string part = {};      // `part 2 of 3`, of a surface with others beside it; or empty
};

// What is asked of a surface from a file.
struct RepairOrder {
  bool repair = true;
  double most_missing = 0.02;    // of the area, that holes or crossing triangles may have
  std::optional<int> part = {};  // by falling volume, from 1; empty: the only part, or the largest
  std::optional<Vec3> pressed = {};  // m; without `part`, the part that is nearest is taken
  int nearest = 0;                   // its number, if near_part() has found it; otherwise 0
  std::string unit = "m";            // in which the file's coordinates were read
};

// The surface itself if it passes check_closed(). Otherwise its vertices within a millionth of its
// size are joined, doubled triangles removed, sheets that share a vertex parted, all triangles
// turned one way, holes filled and triangles replaced that cross others of the same part, if the
// holes, and these triangles, have at most a part of its area. Of several parts one remains, with
// the cavities in it where no part is asked for; parts of less than a thousandth of its volume are
// removed. Throws MeshError as check_closed() and refuse_size() do for what is worse. `name` is
// that of the surface in messages.
[[nodiscard]] WholeSurface whole_surface(geometry::Surface surface, const std::string& name,
                                         const RepairOrder& order);

// The same in two steps, for a surface of which several parts are pressed.
struct MendedSurface {
  geometry::Surface surface;  // all parts
  bool sound = false;         // whether it is as the file gives it
  std::string changes = {};   // of one that is not
  std::string fault = {};     // of the file
};
[[nodiscard]] MendedSurface mended_surface(geometry::Surface surface, const std::string& name,
                                           const RepairOrder& order);
[[nodiscard]] WholeSurface whole_part(const MendedSurface& mended, const std::string& name,
                                      const RepairOrder& order);
// The number of the part that is nearest to a place (m); 0 if there is only one.
[[nodiscard]] int near_part(const MendedSurface& mended, const Vec3& place);

}  // namespace palpate::meshing
