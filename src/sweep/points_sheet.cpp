// The table and the gnuplot script of a sampled sweep: cases as points without lines.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.h"
#include "base/text.h"
#include "plot/gnuplot_text.h"
#include "sweep/labels.h"
#include "sweep/response.h"

namespace palpate::sweep {
namespace {

using sweep::FactorColumn;

constexpr std::size_t most_points = 3000;
constexpr std::size_t most_panels = 6;
constexpr const char* points_file = "sweep_points.csv";

std::size_t every(const sweep::SweepColumns& columns) {
  return (columns.cases + most_points - 1) / most_points;
}

// The factors that are numbers, by falling rank correlation with the output.
std::vector<const FactorColumn*> numbers_by_weight(const sweep::SweepColumns& columns,
                                                   const sweep::OutputColumn& output) {
  std::vector<std::pair<double, const FactorColumn*>> all;
  for (const FactorColumn& factor : columns.factors) {
    if (!factor.is_number()) continue;
    const double correlation = sweep::rank_correlation(factor.values, output.values);
    all.emplace_back(std::isfinite(correlation) ? std::abs(correlation) : 0.0, &factor);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
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
  const bool log = factor.choice.scale == sweep::Scale::logarithmic && range.low > 0.0;
  return {factor.choice.column, factor_label(factor.choice), range, log};
}
Shown shown(const sweep::OutputColumn& output) {
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
         name + "label " + plot::gnuplot_quoted(what.label) + "\n";
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

}  // namespace

record::Table scatter_table(const sweep::SweepColumns& columns) {
  record::Table table{{"number"}, {}};
  for (const FactorColumn& factor : columns.factors) table.columns.push_back(factor.choice.column);
  for (const sweep::OutputColumn& output : columns.outputs) table.columns.push_back(output.name);
  for (std::size_t i = 0; i < columns.cases; i += every(columns)) {
    std::vector<record::Cell> row{static_cast<double>(i + 1)};
    for (const FactorColumn& factor : columns.factors) {
      if (factor.is_number())
        row.emplace_back(factor.values[i]);
      else
        row.emplace_back(factor.words[static_cast<std::size_t>(factor.values[i])]);
    }
    for (const sweep::OutputColumn& output : columns.outputs)
      row.push_back(std::isfinite(output.values[i]) ? record::Cell(output.values[i])
                                                    : record::Cell());
    table.rows.push_back(row);
  }
  return table;
}

std::optional<plot::Sheet> points_sheet(const sweep::SweepColumns& columns,
                                        const sweep::OutputColumn& output,
                                        const std::string& title) {
  const auto factors = numbers_by_weight(columns, output);
  if (factors.empty()) return std::nullopt;
  const bool failed = std::any_of(output.values.begin(), output.values.end(),
                                  [](double value) { return !std::isfinite(value); });
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
                     plot::gnuplot_quoted(whole) + " font ',15'\n";
  for (const std::string& one : panels) text += one;
  return plot::Sheet{name, text + "\nunset multiplot\n", {points_file}};
}

}  // namespace palpate::sweep
