// What a figure shows: curves out of a result folder's CSV files, and the fits over them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/regression.h"

namespace palpate::report {

// A dashed curve over a series, in its colour.
struct FittedCurve {
  std::string formula = {};  // gnuplot's language, a function of x in the CSV's units
  double origin = 0.0;       // x is counted from here, in the CSV's units
  double from = 0.0;         // where the curve is drawn, in the CSV's units
  double to = 0.0;
};

struct Series {
  std::string csv_file = {};   // relative to the result folder
  std::string case_name = {};  // rows whose column `column` says so; empty: all rows
  std::string column = "case";
  std::string x_column = {};
  std::string y_column = {};
  double scale = 1.0;      // for display; the fits are scaled with it, the label says so
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
  std::string fit_label = {};  // the fits' line in the legend
  Axis y_axis = Axis::linear;
  std::vector<Series> series = {};
};

// Force against indentation (Figure 6 of the paper). An empty column or file of a series means
// force_indentation.csv, indentation_mm, force_N.
[[nodiscard]] Figure figure_force_indentation(std::vector<Series> series);

// Force against the tissue's curvature where it is pressed (Figure 6 of the paper, lower graph),
// one point a case: findings.csv, local_curvature_per_m, peak_force_N.
[[nodiscard]] Figure figure_force_curvature(std::vector<Series> series);

// Force along a slide: force_indentation.csv, slide_mm, force_N.
[[nodiscard]] Figure figure_force_slide(std::vector<Series> series);

// Travel along a slide that keeps its force: force_indentation.csv, slide_mm, travel_mm.
[[nodiscard]] Figure figure_travel_slide(std::vector<Series> series);

// Strain against time (Figure 7 of the paper): strain_time.csv, time_s, strain.
[[nodiscard]] Figure figure_strain_time(std::vector<Series> series);

// A fit as a curve to draw over its own data; nothing where it has no finite estimates.
[[nodiscard]] std::optional<FittedCurve> fitted_curve(const fit::Fit& fit);

}  // namespace palpate::report
