// Surfaces as scans have them: small faults are mended and told, larger ones refused.
#pragma once

#include <optional>
#include <string>

#include "geometry/surface.h"

namespace palpate::meshing {

struct WholeSurface {
  geometry::Surface surface;  // has passed check_closed()
  std::string remark;         // what was changed, with places and sizes; empty if nothing was
};

// What is asked of a surface from a file.
struct RepairOrder {
  bool repair = true;
  std::optional<int> part = {};  // by falling volume, from 1; empty: the only part, or the largest
};

// The surface itself if it passes check_closed(). Otherwise its vertices within a millionth of its
// size are joined, doubled triangles removed, sheets that share a vertex parted, all triangles
// turned one way, holes filled and crossing triangles replaced, if the holes, and the crossing
// triangles, have at most 2 % of its area. Of several parts one remains; parts of less than a
// thousandth of its volume are removed. Throws MeshError as check_closed() does for what is worse,
// and for parts inside one another. `name` is that of the surface in messages.
[[nodiscard]] WholeSurface whole_surface(geometry::Surface surface, const std::string& name,
                                         const RepairOrder& order);

}  // namespace palpate::meshing
