// Tables and gnuplot scripts of a sweep: maps and curves of a grid, points of a sample, bars of
// sensitivity; the page that shows them.
#include "sweep/response.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.h"
#include "page/page.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"

namespace palpate::sweep {
namespace {

constexpr std::size_t most_levels = 40;  // six maps then have 2 MB, and the page as much

// A factor of a full grid.
struct GridFactor {
  const FactorColumn* column = nullptr;
  std::size_t stride = 1;               // distance of its levels in the columns, in cases
  std::vector<std::size_t> order = {};  // the levels that are drawn, by value
  std::size_t every = 1;                // every k-th level is drawn
};

std::vector<GridFactor> grid_factors(const SweepColumns& columns) {
  std::vector<GridFactor> all;
  std::size_t stride = columns.cases;
  for (const FactorColumn& factor : columns.factors) {
    stride /= factor.choice.levels;
    GridFactor one{&factor, stride};
    std::vector<std::size_t> order(factor.choice.levels);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (factor.is_number())
      std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return factor.values[a * stride] < factor.values[b * stride];
      });
    one.every = (order.size() + most_levels - 1) / most_levels;
    for (std::size_t i = 0; i < order.size(); i += one.every) one.order.push_back(order[i]);
    all.push_back(one);
  }
  return all;
}

std::string level_text(const FactorColumn& factor, double value) {
  return factor.is_number() ? number_text(value) : factor.words[static_cast<std::size_t>(value)];
}

// The edges of a point's cell in a map: halfway to the neighbouring values, and at the value itself
// where there is none, so that no colour stands beyond what was computed.
struct Edges {
  double low, high;
};
Edges edges(const std::vector<double>& values, std::size_t i, Scale scale) {
  const bool log = scale == Scale::logarithmic;
  const auto between = [&](double a, double b) { return log ? std::sqrt(a * b) : 0.5 * (a + b); };
  const double here = values[i];
  return {i > 0 ? between(values[i - 1], here) : here,
          i + 1 < values.size() ? between(here, values[i + 1]) : here};
}

}  // namespace

std::optional<Response> response(const SweepColumns& columns, const OutputColumn& output,
                                 const std::string& title) {
  const std::vector<GridFactor> factors = grid_factors(columns);
  const GridFactor* across = nullptr;
  const GridFactor* along = nullptr;
  for (const GridFactor& factor : factors) {
    if (!factor.column->is_number() || factor.column->choice.levels < 2) continue;
    if (across == nullptr)
      across = &factor;
    else if (along == nullptr)
      along = &factor;
  }
  if (across == nullptr) return std::nullopt;
  for (const GridFactor& factor : factors)
    if (along == nullptr && !factor.column->is_number()) along = &factor;

  Response made{.name = "response_" + file_word(output.name),
                .title = title + ": " + output_label(output.name),
                .output = output.name,
                .across = across->column->choice};
  std::size_t base = 0;  // the first case with all other factors at their middle levels
  for (const GridFactor& factor : factors) {
    const auto& name = factor.column->choice.name;
    if (&factor == across || &factor == along) {
      if (factor.every > 1)
        made.title += ", one level in " + std::to_string(factor.every) + " of " + name;
      continue;
    }
    const std::size_t middle = factor.order[factor.order.size() / 2];
    base += middle * factor.stride;
    if (factor.column->choice.levels > 1)
      made.title += ", " + name + " = " +
                    level_text(*factor.column, factor.column->values[middle * factor.stride]);
  }
  for (const std::size_t level : across->order)
    made.grid.x.push_back(across->column->values[level * across->stride]);
  const std::vector<std::size_t> single{0};
  for (const std::size_t k : along == nullptr ? single : along->order) {
    const std::size_t from = along == nullptr ? base : base + k * along->stride;
    if (along != nullptr) made.grid.y.push_back(along->column->values[k * along->stride]);
    for (const std::size_t level : across->order)
      made.grid.values.push_back(output.values[from + level * across->stride]);
  }
  if (std::ranges::none_of(made.grid.values, [](double value) { return std::isfinite(value); }))
    return std::nullopt;
  if (along != nullptr) {
    made.along = along->column->choice;
    made.words = along->column->words;
  }
  made.logarithmic = spread_wide(made.grid.values);
  return made;
}

record::Table response_table(const Response& response) {
  const plot::ValueGrid& grid = response.grid;
  const std::string& x = response.across.column;
  record::Table table{{x}, {}};
  if (response.along) table.columns.push_back(response.along->column);
  if (response.is_map())
    for (const std::string& column : {x, response.along->column})
      for (const char* end : {"low_", "high_"}) table.columns.push_back(end + column);
  table.columns.push_back(response.output);
  for (std::size_t j = 0; j * grid.x.size() < grid.values.size(); ++j)
    for (std::size_t i = 0; i < grid.x.size(); ++i) {
      std::vector<record::Cell> row{grid.x[i]};
      if (response.along && !response.is_map())
        row.push_back(response.words[static_cast<std::size_t>(grid.y[j])]);
      if (response.is_map()) {
        const Edges of_x = edges(grid.x, i, response.across.scale);
        const Edges of_y = edges(grid.y, j, response.along->scale);
        row.insert(row.end(), {grid.y[j], of_x.low, of_x.high, of_y.low, of_y.high});
      }
      row.push_back(record::known(grid.values[j * grid.x.size() + i]));
      table.rows.push_back(row);
    }
  return table;
}

namespace {

constexpr std::size_t most_curves = 8;

bool logarithmic(const FactorChoice& factor) { return factor.scale == Scale::logarithmic; }

std::string csv(const Response& response) { return plot::gnuplot_quoted(response.name + ".csv"); }

std::string axis(const char* name, const FactorChoice& factor, double low, double high) {
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
      const bool close = std::ranges::any_of(taken, [&](const auto& other) {
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
  return std::ranges::any_of(response.grid.values,
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
      "set colorbox user origin screen 0.803,0.565 size screen 0.028,0.365\n"
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
    plots.push_back(
        csv(response) + " using (" + known + " ? " + plot::gnuplot_column(x) + " : NaN):(" +
        plot::gnuplot_column(y) +
        ") with points pointtype 2 pointsize 0.8 linewidth 1.2 linecolor rgb '#D55E00' notitle");
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

// The title of the legend, which is narrower than an axis: a long name goes without its first
// words, and has its unit on a second line.
std::string narrow_title(const FactorChoice& factor) {
  std::string label = factor_label(factor);
  constexpr std::size_t most = 15;  // letters
  if (label.size() <= most) return plot::gnuplot_quoted(label);
  const std::size_t end = std::min(label.find(" ("), label.size());
  const std::string unit = label.substr(end);
  label.erase(end);
  while (label.size() > most && label.find(' ') != std::string::npos)
    label.erase(0, label.find(' ') + 1);
  return plot::gnuplot_quoted(label) +
         (unit.empty() ? "" : ".\"\\n\"." + plot::gnuplot_quoted(unit.substr(1)));
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
          plot::gnuplot_quoted(output_label(response.output)) + " offset -0.6,0\n";
  if (response.along)
    text += "set key title " + narrow_title(*response.along) + " left font ',12'\n";
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
  const std::string title = plot::gnuplot_title(response.title);
  const std::string label =
      "set xlabel " + plot::gnuplot_quoted(factor_label(response.across)) + "\n";
  if (both) {
    const Lines lines = lines_of(response);
    if (!lines.segments.empty()) text += data_of_lines(response, lines);
    text += "set multiplot\nset lmargin at screen 0.19\nset rmargin at screen 0.77\nset title " +
            title + "\nset tmargin at screen 0.93\nset bmargin at screen 0.565\n" + label +
            map(response) +
            "unset title\nset tmargin at screen 0.45\nset bmargin at screen 0.1\n"
            "set key at screen 0.787, screen 0.45 left top Left reverse font ',13' samplen 1.6 "
            "spacing 1.15\n"
            "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n" +
            curve_plots(response) + "unset multiplot\n";
  } else {
    const Ends range = ends(response.grid.x);
    text += "set lmargin at screen 0.19\nset rmargin at screen 0.77\nset title " + title + "\n" +
            label + axis("x", response.across, range.low, range.high) +
            "set key at screen 0.787, screen 0.85 left top Left reverse font ',13' samplen 1.6 "
            "spacing 1.15\n"
            "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n" +
            curve_plots(response);
  }
  return {response.name, text, {response.name + ".csv"}};
}

namespace {

constexpr std::size_t most_points = 3000;
constexpr std::size_t most_panels = 6;
constexpr const char* points_file = "sweep_points.csv";

std::size_t every(const SweepColumns& columns) {
  return (columns.cases + most_points - 1) / most_points;
}

// The factors that are numbers, by falling rank correlation with the output.
std::vector<const FactorColumn*> numbers_by_weight(const SweepColumns& columns,
                                                   const OutputColumn& output) {
  std::vector<std::pair<double, const FactorColumn*>> all;
  for (const FactorColumn& factor : columns.factors) {
    if (!factor.is_number()) continue;
    const double correlation = rank_correlation(factor.values, output.values);
    all.emplace_back(std::isfinite(correlation) ? std::abs(correlation) : 0.0, &factor);
  }
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const FactorColumn*> factors;
  for (const auto& [weight, factor] : all) factors.push_back(factor);
  return factors;
}

// A quantity on an axis or in colour.
struct Shown {
  std::string column, label;
  Ends range = {};
  bool logarithmic = false;
};
Shown shown(const FactorColumn& factor) {
  const Ends range = ends(factor.values);
  const bool log = factor.choice.scale == Scale::logarithmic && range.low > 0.0;
  return {factor.choice.column, factor_label(factor.choice), range, log};
}
Shown shown(const OutputColumn& output) {
  return {output.name, output_label(output.name), ends(output.values), spread_wide(output.values)};
}

// The range has a margin of 4 %, so that no point is cut by the frame.
std::string axis(const std::string& name, const Shown& what) {
  const auto [low, high] = what.range;
  const double air = what.logarithmic ? std::pow(high / low, 0.04) : 0.04 * (high - low);
  const double from = what.logarithmic ? low / air : low - air;
  const double to = what.logarithmic ? high * air : high + air;
  return (what.logarithmic ? plot::gnuplot_logarithmic(name, from, to)
                           : plot::gnuplot_linear(name)) +
         "set " + name + "range [" + rounded_text(from, 6) + ":" + rounded_text(to, 6) + "]\nset " +
         name + "label " + plot::gnuplot_quoted(what.label) +
         (name == "cb" ? " offset 1,0\n" : "\n");
}

std::string panel(const Shown& x, const Shown& y, const Shown& colour, const std::string& output,
                  bool failed) {
  const std::string file = plot::gnuplot_quoted(points_file);
  const std::string known = "strcol(" + plot::gnuplot_quoted(output) + ") ne ''";
  std::string text = "\n" + axis("x", x) + axis("y", y) + axis("cb", colour) + "plot \\\n  " +
                     file + " using (" + known + " ? " + plot::gnuplot_column(x.column) +
                     " : NaN):(" + plot::gnuplot_column(y.column) + "):(" +
                     plot::gnuplot_column(colour.column) +
                     ") with points pointtype 7 pointsize 0.45 linecolor palette notitle";
  // A case without an output is drawn at the lower end of the output's axis.
  const std::string height = y.column == output ? "(" + rounded_text(y.range.low, 6) + ")"
                                                : "(" + plot::gnuplot_column(y.column) + ")";
  if (failed)
    text += ", \\\n  " + file + " using (" + known + " ? NaN : " + plot::gnuplot_column(x.column) +
            "):" + height +
            " with points pointtype 2 pointsize 0.6 linewidth 1.2 linecolor rgb '#D55E00' notitle";
  return text + "\n";
}

// One panel per factor, at most five: the output over the factor, coloured by another factor. With
// two numeric factors or more, the first panel is their plane, coloured by the output. Reads
// sweep_points.csv. Nothing if no factor is a number.
std::optional<plot::Sheet> points_sheet(const SweepColumns& columns, const OutputColumn& output,
                                        const std::string& title) {
  const auto factors = numbers_by_weight(columns, output);
  if (factors.empty()) return std::nullopt;
  const bool failed =
      std::ranges::any_of(output.values, [](double value) { return !std::isfinite(value); });
  const Shown of_output = shown(output);
  std::vector<std::string> panels;
  if (factors.size() > 1)
    panels.push_back(panel(shown(*factors[0]), shown(*factors[1]), of_output, output.name, failed));
  for (std::size_t f = 0; f < factors.size() && panels.size() < most_panels; ++f) {
    const Shown colour = factors.size() == 1 ? of_output : shown(*factors[f == 0 ? 1 : 0]);
    panels.push_back(panel(shown(*factors[f]), of_output, colour, output.name, failed));
  }
  const std::string name = "response_" + file_word(output.name);
  std::string whole = title + ": " + of_output.label;
  if (every(columns) > 1) whole += ", one case in " + std::to_string(every(columns));
  if (failed) whole += "; crosses: no value";
  const int height = 72 + 300 * static_cast<int>(panels.size());
  std::string text = plot::gnuplot_head(name, {.height = height}) +
                     "unset key\nset xlabel offset 0,0.4\n" +
                     plot::gnuplot_palette(plot::brightest_line) + "set multiplot layout " +
                     std::to_string(panels.size()) + ",1 margins screen 0.14,0.8," +
                     rounded_text(72.0 / height, 3) + "," + rounded_text(1.0 - 45.0 / height, 3) +
                     " spacing screen 0," + rounded_text(75.0 / height, 3) + " title " +
                     plot::gnuplot_title(whole) + "\n";
  for (const std::string& one : panels) text += one;
  return plot::Sheet{name, text + "\nunset multiplot\n", {points_file}};
}

}  // namespace

record::Table scatter_table(const SweepColumns& columns) {
  record::Table table{{"number"}, {}};
  for (const FactorColumn& factor : columns.factors) table.columns.push_back(factor.choice.column);
  for (const OutputColumn& output : columns.outputs) table.columns.push_back(output.name);
  for (std::size_t i = 0; i < columns.cases; i += every(columns)) {
    std::vector<record::Cell> row{static_cast<double>(i + 1)};
    for (const FactorColumn& factor : columns.factors) {
      if (factor.is_number())
        row.emplace_back(factor.values[i]);
      else
        row.emplace_back(factor.words[static_cast<std::size_t>(factor.values[i])]);
    }
    for (const OutputColumn& output : columns.outputs)
      row.push_back(record::known(output.values[i]));
    table.rows.push_back(row);
  }
  return table;
}

namespace {

// gnuplot's expression for a cell of sensitivity.csv: its value in this row, NaN in all others.
std::string value_of(const SensitivityRow& row, const std::string& column) {
  return "strcol('output') eq " + plot::gnuplot_quoted(row.output) + " && strcol('factor') eq " +
         plot::gnuplot_quoted(row.factor) + " ? column('" + column + "') : NaN";
}

std::string bars(const std::vector<SensitivityRow>& rows, const std::string& share,
                 const std::string& colour, double from, double to) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double place = -static_cast<double>(i);
    const std::string low = number_text(place + from);
    const std::string high = number_text(place + to);
    const std::string middle = number_text(place + 0.5 * (from + to));
    const std::string x = "(" + value_of(rows[i], share) + ")";
    text += (text.empty() ? "" : ", \\\n  ");
    text += "'sensitivity.csv' using " + x + ":(" + middle + "):(0):" + x + ":(" + low + "):(" +
            high + ") with boxxyerror fillstyle solid 1.0 noborder linecolor rgb '#" + colour +
            "' notitle";
    if (std::isfinite(rows[i].indices.total.low))
      text += ", \\\n  'sensitivity.csv' using " + x + ":(" + middle + "):(column('" + share +
              "_low')):(column('" + share +
              "_high')) with xerrorbars pointtype 0 linewidth 1.4 linecolor rgb '#202020' notitle";
  }
  return text;
}

// Bars of first-order and total indices with their intervals, one panel per output. Reads
// sensitivity.csv. Nothing if there are no indices.
std::optional<plot::Sheet> sensitivity_sheet(const Sensitivity& found, const std::string& title) {
  std::vector<std::vector<SensitivityRow>> outputs;
  double least = 0.0;
  double most = 1.0;
  for (const SensitivityRow& row : found.indices) {
    if (outputs.empty() || outputs.back().front().output != row.output) outputs.emplace_back();
    outputs.back().push_back(row);
    for (const Share& share : {row.indices.first, row.indices.total})
      for (const double end : {share.value, share.low, share.high}) {
        if (!std::isfinite(end)) continue;
        least = std::min(least, end);
        most = std::max(most, end);
      }
  }
  if (outputs.empty()) return std::nullopt;
  const std::size_t factors = outputs.front().size();
  std::size_t longest = 0;
  for (const auto& row : outputs.front())
    longest = std::max(longest, plot::key_label(row.factor).size());
  const int panel = 34 + 38 * static_cast<int>(factors);
  const int height = 105 + panel * static_cast<int>(outputs.size());
  const double margin = std::min(0.5, 0.04 + 0.0148 * static_cast<double>(longest));
  std::string text =
      plot::gnuplot_head("sensitivity", {.height = height}) +
      "unset grid\nset grid xtics linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\nunset key\n"
      "set xrange [" +
      rounded_text(least < 0.0 ? least - 0.02 : 0.0, 4) + ":" + rounded_text(most + 0.02, 4) +
      "]\nset yrange [" + number_text(0.5 - static_cast<double>(factors)) +
      ":0.5]\nset title offset 0,-0.7 font ',13'\n"
      "set multiplot layout " +
      std::to_string(outputs.size()) + ",1 margins screen " + rounded_text(margin, 3) + ",0.965," +
      rounded_text(76.0 / height, 3) + "," + rounded_text(1.0 - 62.0 / height, 3) +
      " spacing screen 0.1," + rounded_text(32.0 / height, 3) + " title " +
      plot::gnuplot_title(title + ": shares of the variance") + "\n";
  for (const auto& rows : outputs) {
    std::vector<std::string> tics;
    for (std::size_t i = 0; i < rows.size(); ++i)
      tics.push_back(plot::gnuplot_quoted(plot::key_label(rows[i].factor)) + " " +
                     number_text(-static_cast<double>(i)));
    const bool last = &rows == &outputs.back();
    text += std::string("set format x '") + (last ? "%.10g" : "") + "'\n";
    if (last)
      text +=
          "set label 1 'blue: by itself (first order)   orange: with its interactions (total)' at "
          "screen 0.5, screen " +
          rounded_text(16.0 / height, 3) + " center font ',12' textcolor rgb '#404040'\n";
    text += "set title " + plot::gnuplot_quoted(output_label(rows.front().output)) +
            "\nset ytics (" + joined(tics, ", ") + ")\nplot \\\n  " +
            bars(rows, "first_order", "0072B2", 0.03, 0.33) + ", \\\n  " +
            bars(rows, "total", "D55E00", -0.33, -0.03) + "\n";
  }
  return plot::Sheet{"sensitivity", text + "unset multiplot\n", {"sensitivity.csv"}};
}

}  // namespace

std::vector<std::string> draw_sweep(const SweepColumns& columns, const Sensitivity& found,
                                    const std::string& title, WholeFolder& folder,
                                    const std::optional<plot::DrawOptions>& options) {
  std::vector<std::string> warnings = columns.notes;
  const auto picture = [&](const plot::Sheet& sheet) {
    if (options) plot::draw(sheet, folder, warnings, *options);
  };
  warnings.insert(warnings.end(), found.notes.begin(), found.notes.end());
  if (!found.indices.empty())
    folder.write("sensitivity.csv", record::csv_text(sensitivity_table(found)));
  if (!found.correlations.empty())
    folder.write("correlation.csv", record::csv_text(correlation_table(found)));
  const bool grid = columns.kind == DesignKind::grid;
  if (!grid && !columns.outputs.empty())
    folder.write("sweep_points.csv", record::csv_text(scatter_table(columns)));
  for (const OutputColumn& output : columns.outputs) {
    if (!grid) {
      if (const auto sheet = points_sheet(columns, output, title)) picture(*sheet);
    } else if (const auto made = response(columns, output, title)) {
      folder.write(made->name + ".csv", record::csv_text(response_table(*made)));
      picture(response_sheet(*made));
    }
  }
  if (const auto sheet = sensitivity_sheet(found, title)) picture(*sheet);
  return warnings;
}

namespace {

// `case 3 (Young's modulus = 5 kPa)`, by the number in results.csv
std::string case_text(const SweepColumns& columns, std::size_t at) {
  std::string text;
  for (const FactorColumn& factor : columns.factors) {
    const std::string label = factor_label(factor.choice);
    const std::size_t unit = std::min(label.find(" ("), label.size());
    const double value = factor.values[at];
    text += (text.empty() ? "" : ", ") + within_sentence(label.substr(0, unit)) + " = " +
            (factor.is_number() ? rounded_text(value, 4)
                                : factor.words[static_cast<std::size_t>(value)]);
    if (unit < label.size()) text += " " + label.substr(unit + 2, label.size() - unit - 3);
  }
  return "case " + std::to_string(at + 1) + (text.empty() ? "" : " (" + text + ")");
}

// Which cases have the smallest and the largest value.
std::string extremes(const SweepColumns& columns, const OutputColumn& output) {
  const Ends range = ends(output.values);
  if (!(range.low < range.high)) return {};
  const auto at = [&](double value) {
    return static_cast<std::size_t>(std::ranges::find(output.values, value) -
                                    output.values.begin());
  };
  return "Smallest in " + case_text(columns, at(range.low)) + ", largest in " +
         case_text(columns, at(range.high)) + ".";
}

// For each output its range, and the factor on which it depends most; of the first, whose range is
// the headline, the cases at its ends.
std::vector<std::string> sentences(const SweepColumns& columns, const Sensitivity& found) {
  std::vector<std::string> all;
  for (const OutputColumn& output : columns.outputs) {
    const Ends range = ends(output.values);
    if (!(range.low <= range.high)) continue;
    std::string sentence = &output == columns.outputs.data() ? "" : range_text(output);
    const SensitivityRow* strongest = nullptr;
    for (const SensitivityRow& row : found.indices)
      if (row.output == output.name && std::isfinite(row.indices.total.value) &&
          (strongest == nullptr || row.indices.total.value > strongest->indices.total.value))
        strongest = &row;
    if (strongest != nullptr)
      sentence += (sentence.empty() ? "" : ": ") + percent_text(strongest->indices.total.value) +
                  " of the variance follows " + within_sentence(plot::key_label(strongest->factor));
    if (!sentence.empty()) sentence += ".";
    if (&output == columns.outputs.data())
      if (const std::string cases = extremes(columns, output); !cases.empty())
        sentence += (sentence.empty() ? "" : " ") + cases;
    if (!sentence.empty()) all.push_back(sentence);
  }
  return all;
}

std::string figure_words(const std::string& name) {
  if (name == "sensitivity")
    return "Share of the variance of each output that follows each swept key.";
  return output_label(name.substr(name.find('_') + 1)) + " over the swept keys.";
}

}  // namespace

std::string range_text(const OutputColumn& output) {
  const Ends range = ends(output.values);
  const std::string label = output_label(output.name);
  const std::size_t unit = std::min(label.find(" ("), label.size());
  std::string text = label.substr(0, unit) + " " + rounded_text(range.low, 3) + " to " +
                     rounded_text(range.high, 3);
  if (unit < label.size()) text += " " + label.substr(unit + 2, label.size() - unit - 3);
  return text;
}

void write_sweep_page(const SweepShown& shown, WholeFolder& folder) {
  const Sensitivity& found = shown.found;
  page::Page page(shown.title, "sweep");
  if (!shown.columns.outputs.empty()) {
    const OutputColumn& first = shown.columns.outputs.front();
    page.headline(range_text(first), shown.answer.error());
  }
  std::vector<std::string> of_outputs = sentences(shown.columns, found);
  if (!of_outputs.empty()) {
    page.answer({of_outputs.front()});
    of_outputs.erase(of_outputs.begin());
  }
  page.answer({shown.tested});
  const std::vector<std::string> lines = shown.answer.lines();  // model, what is neglected
  page.answer({lines.begin(), lines.begin() + std::min(std::ssize(lines), std::ptrdiff_t{2})});
  page.answer(of_outputs);
  if (shown.incomplete) page.answer({shown.totals});
  page.figures(page::all_figures(folder, figure_words));
  constexpr std::size_t most = 100;
  page::Markup tables;
  if (!found.indices.empty())
    tables += page::table_of_file(
        "Shares of the variance",
        page::columns_of(sensitivity_table(found),
                         {"output", "factor", "first_order", "total", "total_low", "total_high"}),
        "sensitivity.csv", most);
  if (!found.correlations.empty())
    tables +=
        page::table_of_file("Rank correlations", correlation_table(found), "correlation.csv", most);
  page.section("Sensitivity", tables);
  page.section("Warnings", page::paragraphs(shown.warnings));
  constexpr auto folded = page::Page::Shown::folded;
  page.section("Model and what is neglected",
               page::paragraphs(lines) + page::paragraphs({shown.totals}), folded);
  page.section("Scenario", page::folded("The scenario as written", shown.scenario), folded);
  page.section("How it was made", page::making({.command = shown.command}), folded);
  page::write(std::move(page), folder);
}

}  // namespace palpate::sweep
