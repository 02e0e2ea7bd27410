// Pressure as colour.
#include "report/map_picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "base/text.h"
#include "base/units.h"
#include "plot/gnuplot_text.h"

namespace palpate::report {
namespace {

using page::element;

// The picture has at most 96 pixels a side: of the pixels that one replaces, the largest counts.
constexpr int most_side = 96;

float highest_pressure(const record::PressureMap& map) {
  return map.pressure.empty() ? 0.0F : *std::ranges::max_element(map.pressure);
}

}  // namespace

plot::Sheet map_sheet(const record::PressureMap& map, const std::string& file) {
  const auto mm = [](double metres) { return rounded_text(unit::mm.from_si(metres), 6); };
  std::string rows;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double pressure =
          double{map.pressure[as_index(row) * as_index(map.width) + as_index(column)]};
      rows += (column > 0 ? "," : "") + rounded_text(unit::kPa.from_si(pressure), 4);
    }
    rows += '\n';
  }
  const auto axis = [&](const std::string& name, double first, int count) {
    return "set " + name + "label " + plot::gnuplot_quoted(name + " (mm)") + "\nset " + name +
           "range [" + mm(first - 0.5 * map.pitch) + ":" + mm(first + (count - 0.5) * map.pitch) +
           "]\n";
  };
  const std::string highest =
      rounded_text(unit::kPa.from_si(double{std::max(highest_pressure(map), 1.0F)}), 4);
  return {.name = file,
          .script = plot::gnuplot_head(file, {.height = 500}) + plot::gnuplot_palette() +
                    "unset datafile columnheaders\n"
                    "$pressure << END\n" +
                    rows + "END\nset size ratio -1\n" + axis("x", map.origin.x(), map.width) +
                    axis("y", map.origin.y(), map.height) + "set cbrange [0:" + highest +
                    "]\nset cblabel 'Pressure (kPa)'\n" + "plot $pressure matrix using (" +
                    mm(map.origin.x()) + " + $1 * " + mm(map.pitch) + "):(" + mm(map.origin.y()) +
                    " + $2 * " + mm(map.pitch) + "):($3 > 0 ? $3 : NaN) with image notitle\n"};
}

page::Markup map_picture(const record::PressureMap& map, const std::string& name) {
  const float most = highest_pressure(map);
  const int every = std::max(
      {1, (map.width + most_side - 1) / most_side, (map.height + most_side - 1) / most_side});
  const int width = (map.width + every - 1) / every, height = (map.height + every - 1) / every;
  std::vector<unsigned char> shades(as_index(width) * as_index(height), 0);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const float pressure = map.pressure[as_index(row) * as_index(map.width) + as_index(column)];
      if (!(pressure > 0.0F)) continue;
      const auto shade =
          static_cast<unsigned char>(1 + std::lround(254.0 * double{pressure} / double{most}));
      // Row 0 of a map has the lowest y, row 0 of a picture is at the top.
      unsigned char& pixel =
          shades[as_index(height - 1 - row / every) * as_index(width) + as_index(column / every)];
      pixel = std::max(pixel, shade);
    }
  const auto mm = [](double metres) { return rounded_text(unit::mm.from_si(metres), 3) + " mm"; };
  const std::string highest = rounded_text(unit::kPa.from_si(double{most}), 3) + " kPa";
  const std::string words = (name.empty() ? "Step " : name + ", step ") + std::to_string(map.step) +
                            ", " + rounded_text(map.time, 3) + " s: at most " + highest + ", " +
                            rounded_text(map.contact_force, 3) + " N in all; the picture is " +
                            mm(map.pitch * map.width) + " wide and " + mm(map.pitch * map.height) +
                            " high.";
  std::vector<unsigned char> scale(255);
  for (std::size_t i = 0; i < scale.size(); ++i) scale[i] = static_cast<unsigned char>(i + 1);
  return element("figure", element("img", page::Markup(),
                                   {{"src", page::png_address(width, height, shades)},
                                    {"alt", "Pressure map. " + words},
                                    {"width", std::to_string(width)},
                                    {"height", std::to_string(height)}}) +
                               element("img", page::Markup(),
                                       {{"class", "scale"},
                                        {"alt", ""},
                                        {"src", page::png_address(255, 1, scale)},
                                        {"width", "255"},
                                        {"height", "1"}}) +
                               element("div", element("span", "0") + element("span", highest),
                                       {{"class", "bar"}}) +
                               element("figcaption", words));
}

}  // namespace palpate::report
