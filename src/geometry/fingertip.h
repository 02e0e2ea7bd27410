// The end of an index finger as triangles, for the sphere bodies and for drawing.
#pragma once

#include "geometry/surface.h"

namespace palpate::geometry {

// A distal index finger of 179 triangles: axis along x with the tip at +x, the flattish pad facing
// -z, the nail side +z, mirror-symmetric in y, open at its base in the plane x = 0. Scaled so that
// it encloses `volume` (m^3, above 0) once the base is closed. Its proportions are 18 mm breadth to
// 15 mm depth to 26 mm length: the breadth is the middle of the 16 to 20 mm that K. Dandekar, B. I.
// Raju and M. A. Srinivasan give for human fingertips (J. Biomech. Eng. 125, 2003); depth and
// length are assumed. Shape: docs/theory.md (27).
[[nodiscard]] Surface fingertip(double volume);

// The same surface with its rim closed by triangles around one new vertex, the rim's mean; flat
// where the rim is. For volume, centre of gravity and drawing.
// Needs a surface with one rim; one without comes back as it is.
[[nodiscard]] Surface with_closed_base(const Surface& open);

}  // namespace palpate::geometry
