// An output over the factors of a sweep: maps and curves for grids, points for samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plot/contours.h"
#include "plot/gnuplot.h"
#include "record/table.h"
#include "sweep/columns.h"
#include "sweep/merge.h"
#include "sweep/sensitivity.h"

namespace palpate::sweep {

// An output on a grid over one or two factors, with the other factors at their middle level.
struct Response {
  std::string name = {};  // of its files, without extension
  std::string title = {};
  std::string output = {};                 // column
  FactorChoice across = {};                // x: the first factor that is a number
  std::optional<FactorChoice> along = {};  // y or curves: the next number, else words
  std::vector<std::string> words = {};     // of `along`, if it is not a number
  plot::ValueGrid grid = {};               // y: 0, 1, ... if `along` is not a number
  bool logarithmic = false;                // scale of the values

  [[nodiscard]] bool is_map() const { return along && words.empty(); }
};

// The response on a full grid; nothing if no factor with several levels is a number, or if none of
// the response's cases has a value. Only every k-th level is taken of a factor with more than 40
// levels; the title then states k.
[[nodiscard]] std::optional<Response> response(const SweepColumns& columns,
                                               const OutputColumn& output,
                                               const std::string& title);

// NAME.csv, one row per point, curve after curve: across, along, for a map the edges of the point's
// cell (low_ and high_), and the output, empty if the case has none.
[[nodiscard]] record::Table response_table(const Response& response);

// For two numbers a map with contour lines and up to eight curves below it, otherwise the curves
// alone. A case without a value is a cross in the map and a gap in the curve.
[[nodiscard]] plot::Sheet response_sheet(const Response& response);

// sweep_points.csv: number, factors and outputs of at most 3000 cases, evenly chosen.
[[nodiscard]] record::Table scatter_table(const SweepColumns& columns);

// Writes all tables and figures of a sweep and of its sensitivity() into `folder`; without
// `options` no figures. Returns sentences on what could not be drawn or computed. Throws
// SystemError if a file cannot be written.
[[nodiscard]] std::vector<std::string> draw_sweep(
    const SweepColumns& columns, const Sensitivity& found, const std::string& title,
    WholeFolder& folder, const std::optional<plot::DrawOptions>& options = plot::DrawOptions{});

// `Peak force 0.0157 to 1.76 N`
[[nodiscard]] std::string range_text(const OutputColumn& output);

// What the page of a merged sweep shows.
struct SweepShown {
  const SweepColumns& columns;
  const Sensitivity& found;
  const SweepAnswer& answer;
  std::string title;
  std::string tested;                 // a sentence: what all cases have in common
  std::string totals;                 // a sentence: how many cases were completed
  bool incomplete = false;            // a case failed or is missing
  std::string scenario;               // the text that was planned
  std::string command;                // that repeats it, run in the folder of the page
  std::vector<std::string> warnings;  // sentences
};

// Writes report.html into the folder, whose tables and figures draw_sweep() has written.
void write_sweep_page(const SweepShown& shown, WholeFolder& folder);

}  // namespace palpate::sweep
