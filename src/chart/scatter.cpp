// The gnuplot script of a scatter plot with error bars.
#include "chart/scatter.h"

#include <algorithm>

#include "base/text.h"
#include "chart/table.h"
#include "plot/gnuplot_text.h"
#include "scenario/integrators.h"

namespace palpate::chart {
namespace {

// Each model has the same colour in every chart; a variant without a scene is grey.
std::string colour_of(const std::string& model) {
  constexpr std::array<std::size_t, 6> order{2, 4, 0, 1, 3, 5};
  static_assert(scenario::ladder.size() <= order.size(), "every rung has a colour");
  constexpr std::size_t no_rung = 6;
  for (std::size_t i = 0; i < scenario::ladder.size(); ++i)
    if (model == scenario::ladder[i].word) return plot::line_colours[order[i]];
  return plot::line_colours[no_rung];
}

// Each integrator has its marker in every chart.
std::string marker(const std::string& integrator) {
  constexpr std::array<int, 8> shapes{9, 13, 5, 11, 15, 2, 3, 1};
  static_assert(scenario::integrator_table.size() <= shapes.size(),
                "every integrator has a marker");
  constexpr int no_mesh = 7;
  for (std::size_t i = 0; i < scenario::integrator_table.size(); ++i)
    if (integrator == scenario::integrator_table[i].word) return std::to_string(shapes[i]);
  return std::to_string(no_mesh);
}

// An axis with a margin of a factor of two on both sides.
struct Range {
  double low, high;
};
Range range(double least, double most) { return {least / 2.0, most * 2.0}; }

std::string axis(const char* name, const Range& range) {
  return std::string("set ") + name + "range [" + number_text(range.low) + ":" +
         number_text(range.high) + "]\n" + plot::gnuplot_logarithmic(name, range.low, range.high);
}

std::string frame(const Scatter& scatter) {
  // NaN means missing, not undefined: rows that are not drawn do not break the line of the front.
  return "set datafile missing NaN\n"
         "set title " +
         plot::gnuplot_quoted(scatter.title) +
         "\n"
         "set xlabel 'cost (µs per simulated ms)'\n"
         "set ylabel 'greatest error (%)'\n" +
         axis("x", range(std::min(scatter.least_cost, real_time_cost),
                         std::max(scatter.most_cost, real_time_cost))) +
         axis("y",
              range(100.0 * std::min({scatter.least_error, scatter.floor, scatter.tolerance}),
                    100.0 * std::max({scatter.most_error, scatter.floor, scatter.tolerance}))) +
         "set key outside right top Left reverse samplen 1.6 spacing 1.2 width -1\n"
         "set tmargin 2.5\n";
}

// Lines at real time, at the tolerance and at the error of the reference.
std::string guides(const Scatter& scatter) {
  const std::string tolerance = number_text(100.0 * scatter.tolerance);
  const std::string floor = number_text(100.0 * scatter.floor);
  const std::string cost = number_text(real_time_cost);
  return "set arrow 1 from first " + cost + ", graph 0 to first " + cost +
         ", graph 1 nohead dashtype (6,4) linecolor rgb '#808080'\n"
         "set label 1 'real time' at first " +
         cost +
         ", graph 0.99 offset 0.4,0 left textcolor rgb "
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

// gnuplot's `using` for the rows that meet a condition: NaN as x for all others.
std::string using_rows(const Scatter& scatter, const std::string& condition) {
  return plot::gnuplot_quoted(scatter.csv_file) + " using ((strcol('case') eq " +
         plot::gnuplot_quoted(scatter.case_name) + " && strcol('status') eq 'measured'" +
         (condition.empty() ? "" : " && " + condition) +
         ") ? column('cost_us_per_ms') : NaN):(100*column('claimed_error'))";
}

std::string points(const Scatter& scatter, const std::string& model,
                   const std::string& integrator) {
  return using_rows(scatter, "strcol('model') eq " + plot::gnuplot_quoted(model) +
                                 " && strcol('integrator') eq " +
                                 plot::gnuplot_quoted(integrator)) +
         ":(column('cost_min_us_per_ms')):(column('cost_max_us_per_ms')) with xerrorbars "
         "linewidth 1.2 linecolor rgb '#50" +
         colour_of(model) + "' pointtype " + marker(integrator) + " pointsize 0.8 notitle";
}

// The front as a line; gnuplot sorts its rows by cost.
std::string front(const Scatter& scatter) {
  return using_rows(scatter, "column('pareto') == 1") +
         " smooth unique with lines linewidth 1.6 linecolor rgb '#404040' title 'Pareto front'";
}

std::string ringed(const Scatter& scatter, const std::string& flag, const std::string& style,
                   const std::string& title) {
  return using_rows(scatter, "column('" + flag + "') == 1") + " with points " + style + " title " +
         plot::gnuplot_quoted(title);
}

}  // namespace

plot::Sheet scatter_sheet(const Scatter& scatter) {
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
                    colour_of(model) + "' title " + plot::gnuplot_quoted(model));
  for (const std::string& integrator : scatter.integrators)
    lines.push_back("keyentry with points pointtype " + marker(integrator) +
                    " pointsize 0.9 linecolor rgb '#808080' title " +
                    plot::gnuplot_quoted(integrator.empty() ? "no mesh" : integrator));
  return {scatter.name,
          plot::gnuplot_head(scatter.name, 560) + frame(scatter) + guides(scatter) + "plot \\\n  " +
              joined(lines, ", \\\n  ") + "\n",
          {scatter.csv_file}};
}

}  // namespace palpate::chart
