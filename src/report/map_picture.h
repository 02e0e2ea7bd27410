// A pressure map on a page.
#pragma once

#include <string>

#include "page/html.h"
#include "record/pressure_map.h"

namespace palpate::report {

// The map as a picture with a scale of its pressures and a caption; `name` is that of the case.
[[nodiscard]] page::Markup map_picture(const record::PressureMap& map, const std::string& name);

}  // namespace palpate::report
