// Least-squares regression with the errors of the parameters: the curves that can be fitted, with
// their parameters and units.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/dense.h"
#include "base/words.h"

namespace palpate::fit {

enum class Model {
  logarithmic,            // y = a + b ln x
  power,                  // y = A x^n
  exponential,            // y = B (e^(m x) - 1)
  kelvin_voigt,           // y = y_inf (1 - e^(-x/tau)), creep
  kelvin_voigt_recovery,  // y = y_0 e^(-x/tau), recovery
  standard_linear_solid,  // y = y_inf + (y_0 - y_inf) e^(-x/tau), relaxation
};

// How a parameter's unit is formed from those of x and y.
enum class UnitRule { none, of_y, of_x, per_x, y_per_x_to_n };

struct Parameter {
  std::string_view name;
  UnitRule unit;
};

// One row of the table of models. The linear parameters come first.
struct ModelInfo {
  Model model;
  std::string_view name;     // on the command line and in fits.csv
  std::string_view formula;  // for people
  std::span<const Parameter> parameters;
  bool positive_x_only = false;  // points with x <= 0 are excluded
};

// All models, in the order of the enumeration.
[[nodiscard]] std::span<const ModelInfo> models();
[[nodiscard]] const ModelInfo& info(Model model);

// The model of that name, or nothing.
[[nodiscard]] std::optional<Model> find_model(std::string_view name);

// The curve's value at x; `parameters` in the order of info(model) and in the units of the data.
[[nodiscard]] double value(Model model, std::span<const double> parameters, double x);

// A curve is a sum of at most two terms c_i phi_i(x, q). It is linear in c_i and non-linear in the
// shape parameter q (n, m or tau). The logarithmic model has the terms 1 and ln x, and no q.
[[nodiscard]] std::array<double, 2> terms(Model model, double x, double shape);   // phi_i at x
[[nodiscard]] std::array<double, 2> slopes(Model model, double x, double shape);  // d phi_i / dq

[[nodiscard]] int term_count(Model model);
[[nodiscard]] bool has_shape(Model model);  // whether there is a shape parameter, the last one

// The unit at the end of a column's name: `N` for `force_N`, empty for `strain`.
[[nodiscard]] std::string column_unit(std::string_view column);

// The unit of a parameter, from those of the data: `N/mm^n` or `1/mm` for x in mm and y in N.
[[nodiscard]] std::string unit_text(UnitRule rule, const std::string& x_unit,
                                    const std::string& y_unit);

enum class Termination {
  converged,
  not_converged,  // out of iterations; estimates are those of the last one, errors are NaN
  undetermined,   // a minimum, but the data do not determine every parameter; errors are NaN
  failed,         // the curve cannot be evaluated for these data; all results are NaN
};

// The word for it in fits.csv.
[[nodiscard]] constexpr std::string_view word(Termination termination) {
  return name_of<Termination::failed>(termination);
}

struct Estimate {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string name = {};
  std::string unit = {};
  double estimate = unknown;
  double std_error = unknown;
  double ci95_low = unknown;
  double ci95_high = unknown;
};

// How the intervals take the residuals: as independent, or as correlated from row to row where they
// are (docs/theory.md [correlated], [covariance]).
enum class Residuals { independent, correlated };

struct Fit {
  Model model = Model::logarithmic;
  std::string name = {};  // of a curve that is not in models(): `hertz`, `prony`; empty otherwise
  std::vector<Estimate> parameters = {};  // in the order of info(model)
  dense::Matrix covariance = {};          // of the estimates; empty if unknown
  double r2 = Estimate::unknown;          // 1 - SSE / SST about the mean; NaN if y is constant
  double rmse = Estimate::unknown;        // sqrt(SSE / n), in the unit of y
  int n = 0;                              // points used
  int excluded = 0;  // points that are not finite, or have x <= 0 in a model with ln x or x^n
  double range_low = Estimate::unknown;  // smallest x used, before x_origin is subtracted
  double range_high = Estimate::unknown;
  double x_origin = 0.0;  // the curve is a function of (x - x_origin)
  Termination termination = Termination::failed;
  double rho = 0.0;  // correlation of neighbouring residuals; 0 where taken as independent
  double effective_size = Estimate::unknown;  // independent rows of the same worth
  double durbin_watson = Estimate::unknown;   // of the residuals in the order of the points
  bool gave_way = false;  // rows beyond the largest force are excluded: the specimen gave way
  std::string law = {};   // the formula that was fitted, with its source
  std::vector<std::string> notes = {};     // sentences: what was excluded and what was decided
  std::vector<std::string> warnings = {};  // sentences: why the estimates may be wrong
};

// Its name and formula, which a curve that is not in models() has of its own.
[[nodiscard]] std::string model_name(const Fit& fit);
[[nodiscard]] std::string formula_of(const Fit& fit);

struct Options {
  std::string x_unit = {};  // for the parameters' units, as returned by column_unit
  std::string y_unit = {};
  double x_origin = 0.0;  // subtracted from every x: the time of loading or unloading
  int max_iterations = 200;
  Residuals residuals = Residuals::independent;
};

// Fits `model` to the points (x[i], y[i]) by minimising the sum of squared residuals in y. The same
// input gives the same result. Intervals are Student's t for n - p degrees of freedom, with the
// covariance (J^T J)^-1 SSE / (n - p). Both spans have the same size, in any consistent units.
// Throws InputError if fewer points are usable than parameters + 1.
[[nodiscard]] Fit regress(std::span<const double> x, std::span<const double> y, Model model,
                          const Options& options = {});

// The initial guess of regress(): parameters near the least-squares fit, in the order of
// info(model). For every shape q of a grid (n, or m and tau scaled with the largest |x|) the other
// parameters are linear and solved for by QR; the smallest sum of squares wins (the first, if
// several are equal). Nothing if no shape can be evaluated. x and y must be finite and of equal
// size.
[[nodiscard]] std::optional<std::vector<double>> initial_guess(std::span<const double> x,
                                                               std::span<const double> y,
                                                               Model model);

// 1 - squares / SST about the mean of y; NaN if y is constant.
[[nodiscard]] double r_squared(std::span<const double> y, double squares);

// Refuses fewer usable points than a model needs: "... needs at least 4 points, and 3 are usable".
void need_points(const std::string& model, std::size_t needed, std::size_t usable,
                 const std::string& for_what = "", const std::string& end = "; record more points");

// "3 points are excluded: " and the reason.
[[nodiscard]] std::string excluded_text(std::size_t points, const std::string& why);
// Counts points that are not fitted, with the reason in the notes; does nothing for 0 points.
void leave_out(Fit& fit, std::size_t points, const std::string& why);

// Divides the values by their largest magnitude, and returns it. Where all are 0, refuses them with
// `refusal`, or returns 1 without one.
double scale_to_one(std::vector<double>& values, const char* refusal = nullptr);

// The version of the Ceres library, as `2.1.0`.
[[nodiscard]] std::string ceres_version();

}  // namespace palpate::fit
