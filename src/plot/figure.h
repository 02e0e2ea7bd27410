// Description of a figure: curves from the CSV files of a result folder, and fits to them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palpate::plot {

// A dashed curve in the colour of its series. All values are in the units of the CSV file.
struct FittedCurve {
  std::string formula = {};  // in gnuplot's language, a function of x
  double origin = 0.0;       // the formula's x is the column's value minus `origin`
  double from = 0.0;         // the curve is drawn from here
  double to = 0.0;           // to here
};

struct Series {
  std::string csv_file = {};   // relative to the result folder
  std::string case_name = {};  // only rows with this value in `column`; empty: all rows
  std::string column = "case";
  std::string x_column = {};
  std::string y_column = {};
  double scale = 1.0;      // factor of y for display, of the fits too; stated in a default label
  std::string label = {};  // in the legend; empty: the case's name
  std::vector<FittedCurve> fits = {};
  std::optional<int> step = {};  // rows of this step only
};

enum class Axis { linear, logarithmic };

struct Figure {
  std::string name = {};  // the files' name without its ending
  std::string title = {};
  std::string x_label = {};
  std::string y_label = {};
  std::string fit_label = {};  // legend entry of all fits together
  Axis y_axis = Axis::linear;
  std::vector<Series> series = {};
};

}  // namespace palpate::plot
