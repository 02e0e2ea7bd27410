// The gnuplot script of a map with its curves.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "plot/gnuplot_text.h"
#include "sweep/labels.h"
#include "sweep/response.h"

namespace palpate::sweep {
namespace {

constexpr std::size_t most_curves = 8;

bool logarithmic(const sweep::FactorChoice& factor) {
  return factor.scale == sweep::Scale::logarithmic;
}

std::string csv(const Response& response) { return plot::gnuplot_quoted(response.name + ".csv"); }

std::string axis(const char* name, const sweep::FactorChoice& factor, double low, double high) {
  return std::string("set ") + name + "range [" + number_text(low) + ":" + number_text(high) +
         "]\n" + (logarithmic(factor) ? plot::gnuplot_logarithmic(name, low, high) : "");
}

// gnuplot complains of a scale for a single value; it gets one around it.
std::string scale_of_one(const char* name, const Response& response) {
  const Ends range = ends(response.grid.values);
  if (range.low < range.high) return {};
  const double around = range.low == 0.0 ? 1.0 : 0.1 * std::abs(range.low);
  return std::string("set ") + name + "range [" + rounded_text(range.low - around, 4) + ":" +
         rounded_text(range.high + around, 4) + "]\n";
}

double onto(double value, bool log) { return log ? std::log(value) : value; }
double back(double value, bool log) { return log ? std::exp(value) : value; }

// Contour lines, computed with the logarithms of the axes that have a logarithmic scale.
struct Lines {
  std::vector<double> levels = {};           // values
  std::vector<plot::Segment> segments = {};  // ends on the scales of `straight`
  plot::ValueGrid straight = {};             // the grid, with logarithms where the scale has them
};
Lines lines_of(const Response& response) {
  const bool log_x = logarithmic(response.across);
  const bool log_y = logarithmic(*response.along);
  Lines lines;
  lines.straight = response.grid;
  for (double& x : lines.straight.x) x = onto(x, log_x);
  for (double& y : lines.straight.y) y = onto(y, log_y);
  const Ends range = ends(response.grid.values);
  lines.levels = plot::round_levels(range.low, range.high, 8, response.logarithmic);
  std::vector<double> levels = lines.levels;
  for (double& level : levels) level = onto(level, response.logarithmic);
  for (double& value : lines.straight.values) value = onto(value, response.logarithmic);
  lines.segments = plot::contours(lines.straight, levels);
  return lines;
}

// Contour lines have their labels where they meet a diagonal of the map, to avoid overlaps.
std::string names_of_lines(const Response& response, const Lines& lines) {
  const auto& [xs, ys, values] = lines.straight;
  const auto share = [](double value, const std::vector<double>& all) {
    return (value - all.front()) / (all.back() - all.front());
  };
  const auto slant = [](double u) { return 0.1 + 0.8 * u; };
  std::vector<std::pair<double, double>> taken;
  std::string text;
  for (const double level : lines.levels) {
    const double wanted = onto(level, response.logarithmic);
    double best = INFINITY;
    std::optional<std::pair<double, double>> place;
    for (const plot::Segment& one : lines.segments) {
      if (one.level != wanted) continue;
      const double u0 = share(one.x0, xs), u1 = share(one.x1, xs);
      const double v0 = share(one.y0, ys), v1 = share(one.y1, ys);
      const double off0 = v0 - slant(u0), off1 = v1 - slant(u1);
      const double t = off0 == off1 ? 0.5 : std::clamp(off0 / (off0 - off1), 0.0, 1.0);
      const double u = u0 + t * (u1 - u0);
      const double v = v0 + t * (v1 - v0);
      if (u < 0.05 || u > 0.95 || v < 0.05 || v > 0.95) continue;
      const bool close = std::any_of(taken.begin(), taken.end(), [&](const auto& other) {
        return std::abs(other.first - u) < 0.09 && std::abs(other.second - v) < 0.08;
      });
      if (close || std::abs(v - slant(u)) >= best) continue;
      best = std::abs(v - slant(u));
      place = {u, v};
    }
    if (!place) continue;
    taken.push_back(*place);
    const double x = xs.front() + place->first * (xs.back() - xs.front());
    const double y = ys.front() + place->second * (ys.back() - ys.front());
    text += "set label " + plot::gnuplot_quoted(plot::tick_text(level)) + " at first " +
            rounded_text(back(x, logarithmic(response.across)), 6) + ", first " +
            rounded_text(back(y, logarithmic(*response.along)), 6) +
            " center front boxed font ',12' textcolor rgb '#202020'\n";
  }
  return text;
}

std::string data_of_lines(const Response& response, const Lines& lines) {
  const bool log_x = logarithmic(response.across);
  const bool log_y = logarithmic(*response.along);
  std::string text = "$contours << EOD\nx0,y0,x1,y1\n";  // gnuplot takes the first row for a head
  for (const plot::Segment& one : lines.segments) {
    const std::string x0 = rounded_text(back(one.x0, log_x), 6);
    const std::string y0 = rounded_text(back(one.y0, log_y), 6);
    text += x0 + "," + y0 + "," + rounded_text(back(one.x1, log_x), 6) + "," +
            rounded_text(back(one.y1, log_y), 6) + "\n";
  }
  return text + "EOD\n";
}

bool has_gaps(const Response& response) {
  return std::any_of(response.grid.values.begin(), response.grid.values.end(),
                     [](double value) { return !std::isfinite(value); });
}

std::string map(const Response& response) {
  const std::string& x = response.across.column;
  const std::string& y = response.along->column;
  const Lines lines = lines_of(response);
  const Ends values = ends(response.grid.values);
  const std::string known = "strcol(" + plot::gnuplot_quoted(response.output) + ") eq ''";
  std::string text =
      axis("x", response.across, response.grid.x.front(), response.grid.x.back()) +
      axis("y", *response.along, response.grid.y.front(), response.grid.y.back()) + "set ylabel " +
      plot::gnuplot_quoted(factor_label(*response.along)) + "\n" +
      (response.logarithmic ? plot::gnuplot_logarithmic("cb", values.low, values.high) : "") +
      scale_of_one("cb", response) + "set cblabel " +
      plot::gnuplot_quoted(output_label(response.output)) + " offset 0.2,0\n" +
      "set colorbox user origin screen 0.82,0.565 size screen 0.028,0.365\n"
      "set style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.6,0.4\n" +
      // Edges of SVG are crisp; in other pictures the background would shine through between cells.
      "border = format eq 'svg' ? 'noborder' : 'border linewidth 0.4'\n" +
      names_of_lines(response, lines);
  std::vector<std::string> plots{
      csv(response) + " using (" + known + " ? NaN : " + plot::gnuplot_column(x) + "):(" +
      plot::gnuplot_column(y) + "):(" + plot::gnuplot_column("low_" + x) + "):(" +
      plot::gnuplot_column("high_" + x) + "):(" + plot::gnuplot_column("low_" + y) + "):(" +
      plot::gnuplot_column("high_" + y) + "):(" + plot::gnuplot_column(response.output) +
      ") with boxxyerror fillstyle solid 1.0 @border linecolor palette notitle"};
  if (!lines.segments.empty())
    for (const char* style :
         {"linewidth 2.6 linecolor rgb '#30ffffff'", "linewidth 0.9 linecolor rgb '#202020'"})
      plots.push_back(std::string("$contours using 1:2:($3-$1):($4-$2) with vectors nohead ") +
                      style + " notitle");
  if (has_gaps(response))
    plots.push_back(csv(response) + " using (" + known + " ? " + plot::gnuplot_column(x) +
                    " : NaN):(" + plot::gnuplot_column(y) +
                    ") with points pointtype 2 pointsize 0.8 linewidth 1.2 linecolor rgb '#D55E00' "
                    "notitle");
  return text + "plot \\\n  " + joined(plots, ", \\\n  ") + "\n" + "unset label\n" +
         plot::gnuplot_linear("cb") + plot::gnuplot_linear("y") + "set yrange [*:*]\n";
}

// The curves that are drawn if there are many: the first, the last, and others evenly between.
std::vector<std::size_t> chosen(std::size_t count) {
  std::vector<std::size_t> all;
  const std::size_t shown = std::min(count, most_curves);
  for (std::size_t k = 0; k < shown; ++k)
    all.push_back(shown == 1 ? 0 : (2 * k * (count - 1) + shown - 1) / (2 * (shown - 1)));
  return all;
}

// The legend is narrower than an axis: a long name goes without its unit, and then without its
// first words.
std::string narrow_label(const sweep::FactorChoice& factor) {
  std::string label = factor_label(factor);
  constexpr std::size_t most = 15;  // letters
  if (label.size() > most) label.erase(std::min(label.find(" ("), label.size()));
  while (label.size() > most && label.find(' ') != std::string::npos)
    label.erase(0, label.find(' ') + 1);
  return label;
}

std::string curve_plots(const Response& response) {
  const plot::ValueGrid& grid = response.grid;
  const std::size_t width = grid.x.size();
  const std::size_t count = grid.values.size() / width;
  const bool named = !response.words.empty();
  std::string text;
  if (response.logarithmic) {
    const Ends range = ends(grid.values);
    text += plot::gnuplot_logarithmic("y", range.low / 1.15, range.high * 1.15) + "set yrange [" +
            rounded_text(range.low / 1.15, 4) + ":" + rounded_text(range.high * 1.15, 4) + "]\n";
  }
  text += scale_of_one("y", response) + "set ylabel " +
          plot::gnuplot_quoted(output_label(response.output)) + "\n";
  if (response.along)
    text += "set key title " + plot::gnuplot_quoted(narrow_label(*response.along)) +
            " left font ',12'\n";
  std::vector<std::string> plots;
  for (const std::size_t j : chosen(count)) {
    if (!std::isfinite(ends({&grid.values[j * width], width}).low)) continue;  // gnuplot complains
    const double share = count > 1 ? static_cast<double>(j) / static_cast<double>(count - 1) : 0.0;
    // The brightest colours are excluded, being hard to see on white; words have no order.
    const std::string colour = named || !response.along
                                   ? plot::line_colours[j % plot::line_colours.size()]
                                   : plot::palette_colour(plot::brightest_line * share);
    const std::string title =
        !response.along
            ? "notitle"
            : "title " +
                  plot::gnuplot_quoted(named ? response.words[static_cast<std::size_t>(grid.y[j])]
                                             : rounded_text(grid.y[j], 4));
    plots.push_back(csv(response) + " every ::" + std::to_string(j * width) +
                    "::" + std::to_string((j + 1) * width - 1) + " using (" +
                    plot::gnuplot_column(response.across.column) + "):(strcol(" +
                    plot::gnuplot_quoted(response.output) +
                    ") eq '' ? 1/0 : " + plot::gnuplot_column(response.output) +
                    ") with linespoints linewidth 1.8 pointtype 7 pointsize 0.35 linecolor rgb '#" +
                    colour + "' " + title);
  }
  return text + "plot \\\n  " + joined(plots, ", \\\n  ") + "\n";
}

}  // namespace

plot::Sheet response_sheet(const Response& response) {
  const bool both = response.is_map();
  std::string text = plot::gnuplot_head(response.name, {.height = both ? 720 : 400}) +
                     "set xlabel offset 0,0.6\nset ylabel offset 1,0\n" + plot::gnuplot_palette();
  const std::string title = plot::gnuplot_quoted(response.title);
  const std::string label =
      "set xlabel " + plot::gnuplot_quoted(factor_label(response.across)) + "\n";
  if (both) {
    const Lines lines = lines_of(response);
    if (!lines.segments.empty()) text += data_of_lines(response, lines);
    text += "set multiplot\nset lmargin at screen 0.165\nset rmargin at screen 0.785\nset title " +
            title + "\nset tmargin at screen 0.93\nset bmargin at screen 0.565\n" + label +
            map(response) +
            "unset title\nset tmargin at screen 0.45\nset bmargin at screen 0.1\n"
            "set key at screen 0.805, screen 0.45 left top Left reverse font ',13' samplen 1.6 "
            "spacing 1.15\n"
            "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n" +
            curve_plots(response) + "unset multiplot\n";
  } else {
    const Ends range = ends(response.grid.x);
    text += "set lmargin at screen 0.165\nset rmargin at screen 0.785\nset title " + title + "\n" +
            label + axis("x", response.across, range.low, range.high) +
            "set key at screen 0.805, screen 0.85 left top Left reverse font ',13' samplen 1.6 "
            "spacing 1.15\n"
            "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n" +
            curve_plots(response);
  }
  return {response.name, text, {response.name + ".csv"}};
}

}  // namespace palpate::sweep
