// Speed against accuracy as a picture: the scatter of chart.csv, one colour a model, one marker an
// integrator.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/gnuplot.h"

namespace palpate::report {

struct Scatter {
  std::string name = {};  // the files' name without its ending
  std::string title = {};
  std::string csv_file = {};                  // relative to the folder; columns as in docs/speed.md
  std::string case_name = {};                 // its rows
  std::vector<std::string> models = {};       // that rows were measured with
  std::vector<std::string> integrators = {};  // likewise; "" is none, for models without a mesh
  // Model and integrator of the rows; gnuplot complains of a series without any.
  std::vector<std::pair<std::string, std::string>> series = {};
  std::vector<std::string> marks = {};         // of `knee` and `auto` those that a row has
  double floor = 0.0;                          // the reference's own error
  double tolerance = 0.0;                      // both as ratios
  double least_cost = 1.0, most_cost = 1.0;    // us a simulated ms, of the rows
  double least_error = 1.0, most_error = 1.0;  // ratios, of the rows
};

// Its sheet for draw(), as gnuplot_script() of a Figure is for one: log-log, cost in us a simulated
// ms against the error in percent, with the spread of the timings, the front, its knee, what `auto`
// took, the haptic millisecond, the tolerance, and the reference's own error as the floor.
[[nodiscard]] Sheet scatter_sheet(const Scatter& scatter);

}  // namespace palpate::report
