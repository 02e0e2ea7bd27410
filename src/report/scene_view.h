// The scene on a page: a still picture, which a script of the page can turn.
#pragma once

#include <string>

#include "page/html.h"
#include "record/scene_picture.h"

namespace palpate::report {

// The still picture of scene_svg(). Up to 3000 triangles it comes with two sliders, which appear if
// the browser runs scripts. The picture must have at least one face.
[[nodiscard]] page::Markup scene_view(const record::ScenePicture& picture,
                                      const std::string& title);

// The script of the sliders, for Page::script().
[[nodiscard]] std::string scene_script();

}  // namespace palpate::report
