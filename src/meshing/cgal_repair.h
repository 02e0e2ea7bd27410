// What CGAL does for broken surfaces: joins, parts, turns and fills until they are closed.
#pragma once

#include <vector>

#include "geometry/surface.h"

namespace palpate::meshing::cgal_library {

struct Mending {
  geometry::Surface surface;
  int doubled = 0;    // triangles that were there twice, or had a vertex twice
  int parted = 0;     // vertices that were given to each of the sheets that shared them
  int fragments = 0;  // small open parts that were removed
  struct Hole {
    Vec3 place = Vec3::Zero();  // m, mean of its border
    double around = 0.0;        // m, circumference
    double area = 0.0;          // m^2, of the triangles that fill it
    bool closed = false;
  };
  std::vector<Hole> holes;
  double area = 0.0;      // m^2, with the holes filled
  double crossing = 0.0;  // m^2, of triangles that cut others; these were replaced
};

// Makes a surface closed and turned outwards where that is possible; the caller checks it. It may
// crash or take long: call it in a child process only. The same argument gives the same bits.
[[nodiscard]] Mending mended(const geometry::Surface& surface);

// A closed surface whose triangles that cut others, with some of their neighbours, are replaced by
// those of filled holes; the caller checks it, and calls it in a child process only.
[[nodiscard]] geometry::Surface uncrossed(const geometry::Surface& surface);

}  // namespace palpate::meshing::cgal_library
