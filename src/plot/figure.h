// Description of a figure: curves from the CSV files of a result folder, and fits to them.
#pragma once

#include <cstddef>
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
  std::optional<std::size_t> colour = {};  // of line_colours; none: its place in the list
  std::vector<FittedCurve> fits = {};
  std::optional<int> step = {};       // rows of this step only
  std::optional<double> x_from = {};  // rows from this x on only
  bool dashed = false;                // what another series is compared with
  std::optional<double> shade = {};   // with a colour bar: the value that gives the colour; such
                                      // series have one legend entry per label
};

enum class Axis { linear, logarithmic };

// Colours by a number: from `low` to `high`, with a bar beside the plot.
struct ColourBar {
  std::string label = {};
  double low = 0.0, high = 1.0;
  Axis scale = Axis::linear;
};

struct Figure {
  std::string name = {};  // the files' name without its ending
  std::string title = {};
  std::string x_label = {};
  std::string y_label = {};
  std::string fit_label = {};  // legend entry of all fits together
  std::string legend = {};     // above the legend: the keys, with units, in which the series differ
  Axis x_axis = Axis::linear, y_axis = Axis::linear;
  bool from_zero = false;            // a linear y axis includes zero
  double x_low = 0.0, x_high = 0.0;  // of a logarithmic axis, in the unit of the CSV file
  double y_low = 0.0, y_high = 0.0;
  std::vector<Series> series = {};
  std::optional<ColourBar> bar = {};
};

}  // namespace palpate::plot
