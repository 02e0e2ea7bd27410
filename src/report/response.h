// What an output does over the factors of a sweep: maps and curves of grids, points of samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/table.h"
#include "report/contours.h"
#include "report/gnuplot.h"
#include "study/sensitivity.h"
#include "study/sweep_columns.h"

namespace palpate::report {

// An output on a grid, over two factors or one; of further factors the middle level.
struct Response {
  std::string name = {};  // of its files, without an ending
  std::string title = {};
  std::string output = {};                        // its column
  study::FactorChoice across = {};                // x: the first that is a number
  std::optional<study::FactorChoice> along = {};  // the curves: the next number, else words
  std::vector<std::string> words = {};            // of `along`, where it is no number
  ValueGrid grid = {};                            // y: 0, 1 ... where `along` is no number
  bool logarithmic = false;                       // its values

  [[nodiscard]] bool is_map() const { return along && words.empty(); }
};

// Of a full grid; nothing where no factor is a number. More than a hundred levels of a factor are
// thinned, and the title says so.
[[nodiscard]] std::optional<Response> response(const study::SweepColumns& columns,
                                               const study::OutputColumn& output,
                                               const std::string& title);

// NAME.csv: a row a point, those of a curve behind each other: across, along, what a map paints
// around the point (low_ and high_), the output, empty where there is none.
[[nodiscard]] record::Table response_table(const Response& response);

// A map with lines of equal value where two numbers vary, and up to eight curves below it; a case
// without a value is a cross and a gap.
[[nodiscard]] Sheet response_sheet(const Response& response);

// The cases of any design, at most 3000, evenly chosen: number, factors, outputs.
[[nodiscard]] record::Table scatter_table(const study::SweepColumns& columns);

// A panel a factor, at most five, the output over it in the colour of another; before them, of two
// numbers, their plane in the colour of the output. Reads sweep_points.csv, that table.
[[nodiscard]] std::optional<Sheet> points_sheet(const study::SweepColumns& columns,
                                                const study::OutputColumn& output,
                                                const std::string& title);

// Bars of first order and total indices with their intervals, an output a panel; reads
// sensitivity.csv. Nothing without indices.
[[nodiscard]] std::optional<Sheet> sensitivity_sheet(const study::Sensitivity& found,
                                                     const std::string& title);

// All of a sweep's tables and pictures, written into `folder`; without options no pictures. Throws
// SystemError where the folder takes no files. Warnings are sentences: what could not be drawn or
// said, and why.
struct SweepDrawings {
  std::vector<std::string> files = {};
  std::vector<std::string> warnings = {};
};
[[nodiscard]] SweepDrawings draw_sweep(const study::SweepColumns& columns, const std::string& title,
                                       const std::string& folder,
                                       const std::optional<DrawOptions>& options = DrawOptions{});

}  // namespace palpate::report
