// A picture of the scene as SVG, and to turn on a page.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "page/html.h"
#include "record/record.h"

namespace palpate::report {

// Draws the specimen as shaded triangles in parallel projection, seen from 30 degrees above the
// horizon (below it, where the press comes from below) and from the quarter that the finger comes
// from, with z of the picture upwards; the held surface and its border, also where the body hides
// it; the finger at its first touch, or the load between plates; arrows for displacement and
// slides, the box of the body with numbers along its axes, and a scale bar, in mm. A region that
// contains another one is translucent. Faces are painted in the order of their distance, the
// farthest first, which may be wrong where large triangles surround small ones. The picture must
// have at least one face; the text has about 60 bytes per visible triangle. The same picture gives
// the same bytes.
[[nodiscard]] std::string scene_svg(const record::ScenePicture& picture, const std::string& title);

// The same to turn: scene_svg() with two sliders, which appear if the browser runs the script.
[[nodiscard]] page::Markup scene_view(const record::ScenePicture& picture,
                                      const std::string& title);
[[nodiscard]] std::string scene_script();  // for Page::script()

// From where the picture is seen, degrees: 0 is from -y, then towards +x; and above the horizon.
struct SceneAngles {
  double around = 30.0, tilt = 30.0;
};
[[nodiscard]] SceneAngles scene_angles(const record::ScenePicture& picture);

// The edges of the box around the faces along the scenario's axes, ticks, and their numbers, m.
struct SceneLabel {
  Vec3 at;
  std::string text;
};
struct SceneFrame {
  std::vector<std::array<Vec3, 2>> lines;
  std::vector<SceneLabel> labels;
};
[[nodiscard]] SceneFrame scene_frame(const record::ScenePicture& picture);

// The edges between held and free surface, m.
[[nodiscard]] std::vector<std::array<Vec3, 2>> base_border(const record::ScenePicture& picture);

// The colours of the regions, as `#ecbca0`, then that of the held surface.
[[nodiscard]] std::vector<std::string> scene_colours(const record::ScenePicture& picture);

}  // namespace palpate::report
