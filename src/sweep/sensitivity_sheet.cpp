// The gnuplot script of the sensitivity indices, and draw_sweep(), which writes all figures.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"
#include "sweep/labels.h"
#include "sweep/response.h"

namespace palpate::sweep {
namespace {

// gnuplot's expression for a cell of sensitivity.csv: its value in this row, NaN in all others.
std::string value_of(const sweep::SensitivityRow& row, const std::string& column) {
  return "strcol('output') eq " + plot::gnuplot_quoted(row.output) + " && strcol('factor') eq " +
         plot::gnuplot_quoted(row.factor) + " ? column('" + column + "') : NaN";
}

std::string bars(const std::vector<sweep::SensitivityRow>& rows, const std::string& share,
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

}  // namespace

std::optional<plot::Sheet> sensitivity_sheet(const sweep::Sensitivity& found,
                                             const std::string& title) {
  std::vector<std::vector<sweep::SensitivityRow>> outputs;
  double least = 0.0;
  double most = 1.0;
  for (const sweep::SensitivityRow& row : found.indices) {
    if (outputs.empty() || outputs.back().front().output != row.output) outputs.emplace_back();
    outputs.back().push_back(row);
    for (const sweep::Share& share : {row.indices.first, row.indices.total})
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
      plot::gnuplot_quoted(title + ": shares of the variance") + " font ',15'\n";
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

std::vector<std::string> draw_sweep(const SweepColumns& columns, const Sensitivity& found,
                                    const std::string& title, WholeFolder& folder,
                                    const std::optional<plot::DrawOptions>& options) {
  std::vector<std::string> warnings = columns.notes;
  const auto picture = [&](const plot::Sheet& sheet) {
    if (options) plot::draw(sheet, folder, warnings, *options);
  };
  warnings.insert(warnings.end(), found.notes.begin(), found.notes.end());
  if (!found.indices.empty())
    folder.write("sensitivity.csv", record::csv_text(sweep::sensitivity_table(found)));
  if (!found.correlations.empty())
    folder.write("correlation.csv", record::csv_text(sweep::correlation_table(found)));
  const bool grid = columns.kind == sweep::DesignKind::grid;
  if (!grid && !columns.outputs.empty())
    folder.write("sweep_points.csv", record::csv_text(scatter_table(columns)));
  for (const sweep::OutputColumn& output : columns.outputs) {
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

}  // namespace palpate::sweep
