// A picture of the scene as SVG.
#pragma once

#include <string>

#include "record/scene_picture.h"

namespace palpate::report {

// The specimen as shaded triangles, seen in parallel projection from above, 30 degrees over the
// horizon, x to the right and y into the distance; the finger at its first touch; arrows for travel
// and slides, a scale bar in mm and the axes. A region with another inside it is translucent.
// Hidden faces are painted over, the farthest first, which may be wrong where large triangles
// surround small ones. About 60 bytes a visible triangle. Needs at least one face. The same picture
// gives the same bytes.
[[nodiscard]] std::string scene_svg(const record::ScenePicture& picture, const std::string& title);

}  // namespace palpate::report
