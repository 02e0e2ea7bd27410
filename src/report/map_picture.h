// A pressure map on a page, and as a picture of its own.
#pragma once

#include <string>

#include "page/html.h"
#include "plot/gnuplot.h"
#include "record/record.h"

namespace palpate::report {

// The map as a picture with a scale of its pressures and a caption; `name` is that of the case.
[[nodiscard]] page::Markup map_picture(const record::PressureMap& map, const std::string& name);

// The script that draws the map, with axes in mm and a scale in kPa, into the picture `file`.
[[nodiscard]] plot::Sheet map_sheet(const record::PressureMap& map, const std::string& file);

}  // namespace palpate::report
