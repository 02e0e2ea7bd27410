// The figure of speed against accuracy: a scatter plot of chart.csv, coloured by model.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plot/gnuplot.h"

namespace palpate::chart {

struct Scatter {
  std::string name = {};  // of the files, without extension
  std::string title = {};
  std::string csv_file = {};                  // relative to the folder; columns as in docs/speed.md
  std::string case_name = {};                 // the case whose rows are drawn
  std::vector<std::string> models = {};       // of the rows
  std::vector<std::string> integrators = {};  // of the rows; "" for models without a mesh
  // Pairs of model and integrator that have rows; gnuplot warns of a series without points.
  std::vector<std::pair<std::string, std::string>> series = {};
  std::vector<std::string> marks = {};         // `knee` and `auto`, if a row has the mark
  double floor = 0.0;                          // error of the reference, relative
  double tolerance = 0.0;                      // relative
  double least_cost = 1.0, most_cost = 1.0;    // us per simulated ms, of the rows
  double least_error = 1.0, most_error = 1.0;  // relative, of the rows
};

// The gnuplot script, log-log: cost in us per simulated ms against error in percent, with the
// spread of the timings, the Pareto front, its knee, the choice of `auto`, real time, the
// tolerance, and the error of the reference. One colour per model, one marker per integrator.
[[nodiscard]] plot::Sheet scatter_sheet(const Scatter& scatter);

}  // namespace palpate::chart
