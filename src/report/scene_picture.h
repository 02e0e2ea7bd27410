// A picture of the scene as SVG.
#pragma once

#include <string>

#include "record/scene_picture.h"

namespace palpate::report {

// Draws the specimen as shaded triangles in parallel projection, seen from 30 degrees above the
// horizon with x to the right and y into the distance; the finger at its first touch; arrows for
// travel and slides, a scale bar in mm and the axes. A region that contains another one is
// translucent. Faces are painted in the order of their distance, the farthest first, which may be
// wrong where large triangles surround small ones. The picture must have at least one face; the
// text has about 60 bytes per visible triangle. The same picture gives the same bytes.
[[nodiscard]] std::string scene_svg(const record::ScenePicture& picture, const std::string& title);

// The colour of a region, as `#ecbca0`.
[[nodiscard]] std::string region_colour(int region);

}  // namespace palpate::report
