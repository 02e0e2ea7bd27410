// The script of a scatter with error bars.
#include "report/scatter.h"

#include <algorithm>

#include "base/text.h"
#include "report/gnuplot_text.h"
#include "scenario/words.h"

namespace palpate::report {
namespace {

// The models in the order of the ladder, so that each keeps its colour in every chart.
constexpr std::array<const char*, 4> ladder{"hertz", "layer", "mass_spring", "coupled_springs"};

std::string colour_of(const std::string& model) {
  const auto place = std::find(ladder.begin(), ladder.end(), model) - ladder.begin();
  // Green, orange, blue, red: not the order of curves, whose first two would be the meshes'.
  constexpr std::array<std::size_t, 5> order{2, 4, 0, 1, 6};
  return gnuplot_colours[order[static_cast<std::size_t>(place)]];
}

// Of an integrator, the same in every chart: by its place among the scenario's words, which begin
// with `auto`, in whose stead there is no mesh.
std::string marker(const std::string& integrator) {
  constexpr std::array<int, 9> shapes{7, 9, 13, 5, 11, 15, 2, 3, 1};
  std::size_t place = 0;
  for (std::size_t i = 1; i < scenario::words::integrators.size(); ++i)
    if (integrator == scenario::words::integrators[i].word) place = i;
  return std::to_string(shapes[place % shapes.size()]);
}

constexpr double frame_cost = 1000.0;  // us a ms: a haptic device waits no longer

// With an octave of air around what must be seen.
struct Range {
  double low, high;
};
Range range(double least, double most) { return {least / 2.0, most * 2.0}; }

// `set xrange`, and ticks at 1, 2 and 5 of each decade, where decades alone would be too few.
std::string axis(const char* name, const Range& range) {
  std::string text = std::string("set ") + name + "range [" + number_text(range.low) + ":" +
                     number_text(range.high) + "]\n";
  if (range.high > 300.0 * range.low) return text;
  std::string ticks;
  for (double decade = 1e-6; decade < 1e12; decade *= 10.0)
    for (const double tick : {decade, 2.0 * decade, 5.0 * decade})
      if (tick >= range.low && tick <= range.high)
        ticks += (ticks.empty() ? "" : ", ") + rounded_text(tick, 2);
  return text + "set " + name + "tics (" + ticks + ")\n";
}

std::string frame(const Scatter& scatter) {
  // Missing, not undefined: rows that are passed over do not break the front's line.
  return "set datafile separator comma\n"
         "set datafile missing NaN\n"
         "set datafile columnheaders\n"
         "set title " +
         gnuplot_quoted(scatter.title) +
         "\n"
         "set xlabel 'cost (us a simulated ms)'\n"
         "set ylabel 'greatest error (%)'\n"
         "set logscale xy\n"
         "set format x '%g'\n"
         "set format y '%g'\n" +
         axis("x", range(std::min(scatter.least_cost, frame_cost),
                         std::max(scatter.most_cost, frame_cost))) +
         axis("y",
              range(100.0 * std::min({scatter.least_error, scatter.floor, scatter.tolerance}),
                    100.0 * std::max({scatter.most_error, scatter.floor, scatter.tolerance}))) +
         "set border 3 linewidth 1.2 linecolor rgb '#404040'\n"
         "set tics nomirror out scale 0.6 textcolor rgb '#202020'\n"
         "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n"
         "set key outside right top Left reverse samplen 1.6 spacing 1.2 width -1\n"
         "set tmargin 2.5\n";
}

// The lines that a chart is read by: the frame of a haptic device, the tolerance, the floor.
std::string guides(const Scatter& scatter) {
  const std::string tolerance = number_text(100.0 * scatter.tolerance);
  const std::string floor = number_text(100.0 * scatter.floor);
  return "set arrow 1 from first 1000, graph 0 to first 1000, graph 1 nohead dashtype (6,4) "
         "linecolor rgb '#808080'\n"
         "set label 1 'real time' at first 1000, graph 0.99 offset 0.4,0 left textcolor rgb "
         "'#606060' font ',12'\n"
         "set arrow 2 from graph 0, first " +
         tolerance + " to graph 1, first " + tolerance +
         " nohead dashtype (6,4) linecolor rgb '#808080'\n"
         "set label 2 'tolerance' at graph 0.01, first " +
         tolerance +
         " offset 0,0.5 left textcolor rgb '#606060' font ',12'\n"
         "set arrow 3 from graph 0, first " +
         floor + " to graph 1, first " + floor +
         " nohead linewidth 1.5 linecolor rgb '#a0a0a0'\n"
         "set label 3 'the reference''s own error' at graph 0.99, first " +
         floor + " offset 0,-0.6 right textcolor rgb '#606060' font ',12'\n";
}

// x of the rows that meet a condition, no number elsewhere.
std::string using_rows(const Scatter& scatter, const std::string& condition) {
  return gnuplot_quoted(scatter.csv_file) + " using ((strcol('case') eq " +
         gnuplot_quoted(scatter.case_name) + " && strcol('status') eq 'measured'" +
         (condition.empty() ? "" : " && " + condition) +
         ") ? column('cost_us_per_ms') : NaN):(100*column('claimed_error'))";
}

std::string points(const Scatter& scatter, const std::string& model,
                   const std::string& integrator) {
  return using_rows(scatter, "strcol('model') eq " + gnuplot_quoted(model) +
                                 " && strcol('integrator') eq " + gnuplot_quoted(integrator)) +
         ":(column('cost_min_us_per_ms')):(column('cost_max_us_per_ms')) with xerrorbars "
         "linewidth 1.2 linecolor rgb '#50" +
         colour_of(model) + "' pointtype " + marker(integrator) + " pointsize 0.8 notitle";
}

// Rows of the front from cheap to right: gnuplot sorts them by cost.
std::string front(const Scatter& scatter) {
  return using_rows(scatter, "column('pareto') == 1") +
         " smooth unique with lines linewidth 1.6 linecolor rgb '#404040' title 'Pareto front'";
}

std::string ringed(const Scatter& scatter, const std::string& flag, const std::string& style,
                   const std::string& title) {
  return using_rows(scatter, "column('" + flag + "') == 1") + " with points " + style + " title " +
         gnuplot_quoted(title);
}

}  // namespace

Sheet scatter_sheet(const Scatter& scatter) {
  std::vector<std::string> lines;
  lines.push_back(front(scatter));
  for (const auto& [model, integrator] : scatter.series)
    lines.push_back(points(scatter, model, integrator));
  for (const std::string& mark : scatter.marks)
    lines.push_back(mark == "knee"
                        ? ringed(scatter, mark,
                                 "pointtype 6 pointsize 2.2 linewidth 2.2 linecolor rgb '#000000'",
                                 "knee")
                        : ringed(scatter, mark,
                                 "pointtype 4 pointsize 2.0 linewidth 2.2 linecolor rgb '#CC79A7'",
                                 "taken by auto"));
  for (const std::string& model : scatter.models)
    lines.push_back("keyentry with points pointtype 5 pointsize 1.2 linecolor rgb '#" +
                    colour_of(model) + "' title " + gnuplot_quoted(model));
  for (const std::string& integrator : scatter.integrators)
    lines.push_back("keyentry with points pointtype " + marker(integrator) +
                    " pointsize 0.9 linecolor rgb '#808080' title " +
                    gnuplot_quoted(integrator.empty() ? "no mesh" : integrator));
  return {scatter.name,
          gnuplot_head(scatter.name, 560) + frame(scatter) + guides(scatter) + "plot \\\n  " +
              joined(lines, ", \\\n  ") + "\n",
          {scatter.csv_file}};
}

}  // namespace palpate::report
