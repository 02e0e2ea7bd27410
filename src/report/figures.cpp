// The figures of a result folder, and fits as gnuplot formulas.
#include "report/figures.h"

#include <cmath>

#include "base/text.h"

namespace palpate::report {
namespace {

// The file and columns that a figure uses for a series that names none.
struct Columns {
  const char* file;
  const char* x;
  const char* y;
};

std::vector<plot::Series> completed(std::vector<plot::Series> series, const Columns& columns) {
  for (plot::Series& each : series) {
    if (each.csv_file.empty()) each.csv_file = columns.file;
    if (each.x_column.empty()) each.x_column = columns.x;
    if (each.y_column.empty()) each.y_column = columns.y;
  }
  return series;
}

// Puts negative numbers into brackets, so that they can follow an operator.
std::string operand(double number) {
  return number < 0.0 ? "(" + number_text(number) + ")" : number_text(number);
}

std::string formula(fit::Model model, const std::vector<std::string>& p) {
  switch (model) {
    case fit::Model::logarithmic: return p[0] + " + " + p[1] + "*log(x)";
    case fit::Model::power: return p[0] + "*x**" + p[1];
    case fit::Model::exponential: return p[0] + "*(exp(" + p[1] + "*x) - 1)";
    case fit::Model::kelvin_voigt: return p[0] + "*(1 - exp(-x/" + p[1] + "))";
    case fit::Model::kelvin_voigt_recovery: return p[0] + "*exp(-x/" + p[1] + ")";
    case fit::Model::standard_linear_solid:
      return p[0] + " + (" + p[1] + " - " + p[0] + ")*exp(-x/" + p[2] + ")";
  }
  return {};
}

}  // namespace

plot::Figure figure_force_indentation(std::vector<plot::Series> series) {
  return {.name = "figure_force_indentation",
          .title = "Palpation force against indentation",
          .x_label = "Indentation h (mm)",
          .y_label = "Force F (N)",
          .from_zero = true,
          .series =
              completed(std::move(series), {"force_indentation.csv", "indentation_mm", "force_N"})};
}

plot::Figure figure_force_curvature(std::vector<plot::Series> series) {
  return {.name = "figure_force_curvature",
          .title = "Palpation force against local curvature",
          .x_label = "Mean curvature, convex positive (1/m)",
          .y_label = "Force F (N)",
          .from_zero = true,
          .series = completed(std::move(series),
                              {"findings.csv", "local_curvature_per_m", "peak_force_N"})};
}

plot::Figure figure_force_slide(std::vector<plot::Series> series) {
  return {.name = "figure_force_slide",
          .title = "Force along the slide",
          .x_label = "Slide (mm)",
          .y_label = "Force F (N)",
          .from_zero = true,
          .series = completed(std::move(series), {"force_indentation.csv", "slide_mm", "force_N"})};
}

plot::Figure figure_travel_slide(std::vector<plot::Series> series) {
  return {
      .name = "figure_travel_slide",
      .title = "Travel along the slide at the same force",
      .x_label = "Slide (mm)",
      .y_label = "Travel (mm)",
      .series = completed(std::move(series), {"force_indentation.csv", "slide_mm", "travel_mm"})};
}

plot::Figure figure_strain_time(std::vector<plot::Series> series) {
  return {.name = "figure_strain_time",
          .title = "Strain against time",
          .x_label = "Time (s)",
          .y_label = "Strain",
          .fit_label = "Kelvin-Voigt fit",
          .from_zero = true,
          .series = completed(std::move(series), {"strain_time.csv", "time_s", "strain"})};
}

plot::Figure figure_stress_time(std::vector<plot::Series> series) {
  return {.name = "figure_stress_time",
          .title = "Stress against time",
          .x_label = "Time (s)",
          .y_label = "Stress (kPa)",
          .fit_label = "Standard linear solid fit",
          .from_zero = true,
          .series = completed(std::move(series), {"strain_time.csv", "time_s", "stress_kPa"})};
}

plot::Figure figure_stress_strain(std::vector<plot::Series> series) {
  return {.name = "figure_stress_strain",
          .title = "Stress against strain",
          .x_label = "Strain",
          .y_label = "Stress (kPa)",
          .from_zero = true,
          .series = completed(std::move(series), {"strain_time.csv", "strain", "stress_kPa"})};
}

plot::Figure figure_force_time(std::vector<plot::Series> series) {
  return {.name = "figure_force_time",
          .title = "Force against time",
          .x_label = "Time (s)",
          .y_label = "Force F (N)",
          .from_zero = true,
          .series = completed(std::move(series), {"force_indentation.csv", "time_s", "force_N"})};
}

std::optional<plot::FittedCurve> fitted_curve(const fit::Fit& fit) {
  std::vector<std::string> parameters;
  for (const fit::Estimate& parameter : fit.parameters) {
    if (!std::isfinite(parameter.estimate)) return std::nullopt;
    parameters.push_back(operand(parameter.estimate));
  }
  return plot::FittedCurve{formula(fit.model, parameters), fit.x_origin, fit.range_low,
                           fit.range_high};
}

}  // namespace palpate::report
