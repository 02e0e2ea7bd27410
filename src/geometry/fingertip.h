// The end of an index finger as a triangulated surface, for packing spheres and for drawing.
#pragma once

#include "geometry/surface.h"

namespace palpate::geometry {

// The last part of an index finger, 179 triangles: axis along x with the tip at +x, the flatter pad
// towards -z, the nail side towards +z, mirror-symmetric in y, open at its base in the plane x = 0.
// It is scaled so that it encloses `volume` (m^3, above 0) with the base closed. The proportions
// are 18 mm breadth to 15 mm depth to 26 mm length. The breadth is the middle of the 16 to 20 mm
// that K. Dandekar, B. I. Raju and M. A. Srinivasan give for human fingertips (J. Biomech. Eng.
// 125, 2003); depth and length are assumed. Shape: docs/theory.md [fingertip].
[[nodiscard]] Surface fingertip(double volume);

// The surface with its rim closed by triangles around a new vertex at the mean of the rim; flat if
// the rim is plane. For volume, centre of gravity and drawing. `open` has one rim; a surface
// without a rim is returned unchanged.
[[nodiscard]] Surface with_closed_base(const Surface& open);

}  // namespace palpate::geometry
