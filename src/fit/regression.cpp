// Selects the usable points, starts the search, and computes the errors of its result.
#include "fit/regression.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/index.h"
#include "base/numerics.h"
#include "fit/ceres_fit.h"
#include "fit/residuals.h"

namespace palpate::fit {
namespace {

// The usable points.
struct CurvePoints {
  std::vector<double> x;  // minus x_origin
  std::vector<double> y;  // divided by y_scale
  double y_scale = 1.0;   // largest |y|
};

CurvePoints usable(std::span<const double> x, std::span<const double> y, const Options& options,
                   Fit& fit) {
  CurvePoints points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double from_origin = x[i] - options.x_origin;
    const bool outside = info(fit.model).positive_x_only && from_origin <= 0.0;
    if (!std::isfinite(from_origin) || !std::isfinite(y[i]) || outside) continue;
    points.x.push_back(from_origin);
    points.y.push_back(y[i]);
    fit.range_low = std::fmin(fit.range_low, x[i]);  // fmin ignores the initial NaN
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  points.y_scale = scale_to_one(points.y);
  fit.n = static_cast<int>(points.x.size());
  fit.excluded = static_cast<int>(x.size()) - fit.n;
  return points;
}

// From (J^T J)^-1: covariance, standard errors and intervals.
void set_errors(Fit& fit, const Minimum& minimum, const Scaling& scaling) {
  const std::size_t count = fit.parameters.size();
  double degrees = fit.n - static_cast<double>(count);
  if (scaling.residuals == Residuals::correlated) {
    const std::span<const double> y(scaling.y);
    ResidualErrors found =
        errors_of(minimum.residuals, minimum.jacobian, minimum.inverse_normal, {&y, 1});
    fit.rho = found.rho;
    if (found.rho > 0.0) fit.effective_size = fit.n / found.factor;
    fit.covariance = std::move(found.covariance);
    degrees = found.degrees;
  } else {
    fit.covariance = minimum.inverse_normal * minimum.squares / degrees;
  }
  const Eigen::Map<const Eigen::VectorXd> scale(scaling.parameters.data(), fit.covariance.rows());
  fit.covariance.array() *= (scale * scale.transpose()).array();
  const double t = numerics::student_t_quantile(0.975, degrees);
  for (std::size_t i = 0; i < count; ++i) {
    Estimate& parameter = fit.parameters[i];
    parameter.std_error = std::sqrt(fit.covariance.diagonal()[static_cast<Eigen::Index>(i)]);
    parameter.ci95_low = parameter.estimate - t * parameter.std_error;
    parameter.ci95_high = parameter.estimate + t * parameter.std_error;
  }
}

std::vector<double> shapes(Model model, double scale) {
  std::vector<double> grid;
  switch (model) {
    case Model::logarithmic: return {0.0};
    case Model::power:
      for (int i = -16; i <= 40; ++i) grid.push_back(0.25 * i);
      break;
    case Model::exponential:  // |m| from 1e-3 to 1e2 divided by the largest |x|, both signs
      for (int i = -24; i <= 16; ++i)
        for (const double sign : {1.0, -1.0})
          grid.push_back(sign * std::pow(10.0, i / 8.0) / scale);
      break;
    case Model::kelvin_voigt:
    case Model::kelvin_voigt_recovery:
    case Model::standard_linear_solid:  // tau from 1e-3 to 1e3 times the largest |x|
      for (int i = -24; i <= 24; ++i) grid.push_back(std::pow(10.0, i / 8.0) * scale);
      break;
  }
  return grid;
}

// The terms of a model at all points for one value of its shape parameter.
struct Trial {
  double shape;
  Eigen::MatrixXd terms;
};

// Those of the last points on this thread: the cases of a sweep have the same ones.
const std::vector<Trial>& trials(std::span<const double> x, Model model) {
  struct Known {
    std::vector<double> x;
    std::vector<Trial> trials;
  };
  thread_local std::map<Model, Known> all;
  Known& known = all[model];
  if (!known.trials.empty() && std::equal(x.begin(), x.end(), known.x.begin(), known.x.end()))
    return known.trials;
  known = {{x.begin(), x.end()}, {}};
  double scale = 0.0;
  for (const double each : x) scale = std::max(scale, std::abs(each));
  const auto n = static_cast<Eigen::Index>(x.size());
  const int count = term_count(model);
  for (const double shape : shapes(model, scale == 0.0 ? 1.0 : scale)) {
    Trial trial{shape, Eigen::MatrixXd(n, count)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto phi = terms(model, x[as_index(i)], shape);
      for (int k = 0; k < count; ++k) trial.terms(i, k) = phi[as_index(k)];
    }
    if (trial.terms.allFinite()) known.trials.push_back(std::move(trial));
  }
  return known.trials;
}

Termination termination_of(const Minimum& minimum) {
  if (minimum.status == Minimum::Status::failed) return Termination::failed;
  if (minimum.status == Minimum::Status::out_of_iterations) return Termination::not_converged;
  return minimum.inverse_normal.size() == 0 ? Termination::undetermined : Termination::converged;
}

}  // namespace

void settle(Fit& fit, const Minimum& minimum, const Scaling& scaling) {
  fit.termination = termination_of(minimum);
  if (fit.termination == Termination::failed) return;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    fit.parameters[i].estimate = minimum.parameters[i] * scaling.parameters[i];
  fit.rmse = std::sqrt(minimum.squares / fit.n) * scaling.y_scale;
  fit.r2 = r_squared(scaling.y, minimum.squares);
  fit.durbin_watson = durbin_watson(minimum.residuals);
  if (fit.termination == Termination::converged) set_errors(fit, minimum, scaling);
}

std::optional<std::vector<double>> initial_guess(std::span<const double> x,
                                                 std::span<const double> y, Model model) {
  const Eigen::Map<const Eigen::VectorXd> target(y.data(), static_cast<Eigen::Index>(x.size()));
  std::optional<std::vector<double>> best;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd linear(term_count(model));
  for (const auto& [shape, matrix] : trials(x, model)) {
    double sum = 0.0;
    if (linear.size() == 1) {
      const double along = matrix.col(0).dot(target);
      linear[0] = along / matrix.col(0).squaredNorm();
      sum = target.squaredNorm() - along * linear[0];
    } else {
      linear = dense::least_squares(matrix, target);
      sum = (matrix.lazyProduct(linear) - target).squaredNorm();
    }
    if (!(sum < least) || !linear.allFinite()) continue;
    least = sum;
    best.emplace(linear.begin(), linear.end());
    if (has_shape(model)) best->push_back(shape);
  }
  return best;
}

double r_squared(std::span<const double> y, double squares) {
  const Eigen::Map<const Eigen::ArrayXd> all(y.data(), static_cast<Eigen::Index>(y.size()));
  const double total = (all - all.mean()).square().sum();
  return total > 0.0 ? 1.0 - squares / total : Estimate::unknown;
}

std::string model_name(const Fit& fit) {
  return fit.name.empty() ? std::string(info(fit.model).name) : fit.name;
}
std::string formula_of(const Fit& fit) {
  return fit.name.empty() ? std::string(info(fit.model).formula) : fit.law;
}

void need_points(const std::string& model, std::size_t needed, std::size_t usable,
                 const std::string& for_what, const std::string& end) {
  if (usable >= needed) return;
  throw InputError({}, "the model `" + model + "` needs at least " + std::to_string(needed) +
                           " points" + for_what + ", and " + std::to_string(usable) +
                           (usable == 1 ? " is" : " are") + " usable" + end);
}

std::string excluded_text(std::size_t points, const std::string& why) {
  return std::to_string(points) + (points == 1 ? " point is" : " points are") + " excluded: " + why;
}

void leave_out(Fit& fit, std::size_t points, const std::string& why) {
  if (points == 0) return;
  fit.excluded += static_cast<int>(points);
  fit.notes.push_back(excluded_text(points, why));
}

double scale_to_one(std::vector<double>& values, const char* refusal) {
  double largest = 0.0;
  for (const double each : values) largest = std::max(largest, std::abs(each));
  if (!(largest > 0.0) && refusal != nullptr) throw InputError({}, refusal);
  if (!(largest > 0.0)) return 1.0;
  for (double& each : values) each /= largest;
  return largest;
}

Fit regress(std::span<const double> x, std::span<const double> y, Model model,
            const Options& options) {
  assert(x.size() == y.size());
  Fit fit;
  fit.model = model;
  fit.x_origin = options.x_origin;
  for (const Parameter& parameter : info(model).parameters)
    fit.parameters.push_back({.name = std::string(parameter.name),
                              .unit = unit_text(parameter.unit, options.x_unit, options.y_unit)});
  const CurvePoints points = usable(x, y, options, fit);
  const std::string why = info(model).positive_x_only ? ", or x not above 0)" : ")";
  need_points(
      std::string(info(model).name), fit.parameters.size() + 1, points.x.size(), "",
      (fit.excluded > 0 ? " (" + std::to_string(fit.excluded) + " excluded: not finite" + why
                        : "") +
          "; record more points, or fit a model with fewer parameters");

  const auto start = initial_guess(points.x, points.y, model);
  if (!start) return fit;
  std::vector<double> scale(start->size(), points.y_scale);
  if (has_shape(model)) scale.back() = 1.0;
  const Minimum minimum = minimise(points.x, points.y, model, *start, options.max_iterations);
  settle(fit, minimum, {points.y, points.y_scale, scale, options.residuals});
  return fit;
}

// The table of models and their formulas.

namespace {

constexpr std::array logarithmic{Parameter{"a", UnitRule::of_y}, Parameter{"b", UnitRule::of_y}};
constexpr std::array power{Parameter{"A", UnitRule::y_per_x_to_n}, Parameter{"n", UnitRule::none}};
constexpr std::array exponential{Parameter{"B", UnitRule::of_y}, Parameter{"m", UnitRule::per_x}};
constexpr std::array creep{Parameter{"y_inf", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};
constexpr std::array recovery{Parameter{"y_0", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};
constexpr std::array relaxation{Parameter{"y_inf", UnitRule::of_y},
                                Parameter{"y_0", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};

constexpr std::array<ModelInfo, 6> table{{
    {Model::logarithmic, "logarithmic", "y = a + b ln x", logarithmic, true},
    {Model::power, "power", "y = A x^n", power, true},
    {Model::exponential, "exponential", "y = B (e^(m x) - 1)", exponential},
    {Model::kelvin_voigt, "kelvin_voigt", "y = y_inf (1 - e^(-x/tau))", creep},
    {Model::kelvin_voigt_recovery, "kelvin_voigt_recovery", "y = y_0 e^(-x/tau)", recovery},
    {Model::standard_linear_solid, "standard_linear_solid", "y = y_inf + (y_0 - y_inf) e^(-x/tau)",
     relaxation},
}};

constexpr std::array<std::string_view, 16> unit_words{
    "m", "mm", "um", "nm", "s", "ms", "us", "min", "N", "mN", "uN", "Pa", "kPa", "MPa", "J", "mJ"};

}  // namespace

std::span<const ModelInfo> models() { return table; }

const ModelInfo& info(Model model) {
  const ModelInfo& row = table[as_index(model)];
  assert(row.model == model);
  return row;
}

std::optional<Model> find_model(std::string_view name) {
  for (const ModelInfo& row : table)
    if (row.name == name) return row.model;
  return std::nullopt;
}

bool has_shape(Model model) { return model != Model::logarithmic; }

int term_count(Model model) {
  return static_cast<int>(info(model).parameters.size()) - (has_shape(model) ? 1 : 0);
}

std::array<double, 2> terms(Model model, double x, double shape) {
  switch (model) {
    case Model::logarithmic: return {1.0, std::log(x)};
    case Model::power: return {std::pow(x, shape)};
    case Model::exponential: return {std::expm1(shape * x)};  // accurate for small m x
    case Model::kelvin_voigt: return {-std::expm1(-x / shape)};
    case Model::kelvin_voigt_recovery: return {std::exp(-x / shape)};
    case Model::standard_linear_solid: return {-std::expm1(-x / shape), std::exp(-x / shape)};
  }
  return {};
}

std::array<double, 2> slopes(Model model, double x, double shape) {
  const auto left = [&] { return x / (shape * shape) * std::exp(-x / shape); };
  switch (model) {
    case Model::logarithmic: return {};
    case Model::power: return {std::pow(x, shape) * std::log(x)};
    case Model::exponential: return {x * std::exp(shape * x)};
    case Model::kelvin_voigt: return {-left()};  // d/dtau (1 - e^(-x/tau)) = -(x/tau^2) e^(-x/tau)
    case Model::kelvin_voigt_recovery: return {left()};
    case Model::standard_linear_solid: return {-left(), left()};
  }
  return {};
}

double value(Model model, std::span<const double> parameters, double x) {
  assert(parameters.size() == info(model).parameters.size());
  const auto phi = terms(model, x, parameters.back());
  double sum = 0.0;
  for (int i = 0; i < term_count(model); ++i) {
    const auto k = as_index(i);
    sum += parameters[k] * phi[k];
  }
  return sum;
}

std::string column_unit(std::string_view column) {
  const std::size_t underscore = column.rfind('_');
  if (underscore == std::string_view::npos) return {};
  const std::string_view last = column.substr(underscore + 1);
  for (const std::string_view unit : unit_words)
    if (last == unit) return std::string(unit);
  return {};
}

std::string unit_text(UnitRule rule, const std::string& x_unit, const std::string& y_unit) {
  const std::string above = y_unit.empty() ? "1" : y_unit;
  switch (rule) {
    case UnitRule::none: return {};
    case UnitRule::of_y: return y_unit;
    case UnitRule::of_x: return x_unit;
    case UnitRule::per_x: return x_unit.empty() ? std::string() : "1/" + x_unit;
    case UnitRule::y_per_x_to_n: return x_unit.empty() ? y_unit : above + "/" + x_unit + "^n";
  }
  return {};
}

}  // namespace palpate::fit
