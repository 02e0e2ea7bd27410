// Selects the usable points, starts the search, and computes the errors of its result.
#include "fit/regression.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "base/numerics.h"
#include "fit/ceres_fit.h"
#include "fit/correlated.h"
#include "fit/initial.h"
#include "fit/residual_tests.h"
#include "fit/settle.h"

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
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double from_origin = x[i] - options.x_origin;
    const bool outside = info(fit.model).positive_x_only && from_origin <= 0.0;
    if (!std::isfinite(from_origin) || !std::isfinite(y[i]) || outside) continue;
    points.x.push_back(from_origin);
    points.y.push_back(y[i]);
    largest = std::max(largest, std::abs(y[i]));
    fit.range_low = std::fmin(fit.range_low, x[i]);  // fmin ignores the initial NaN
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  if (largest > 0.0) points.y_scale = largest;
  for (double& each : points.y) each /= points.y_scale;
  fit.n = static_cast<int>(points.x.size());
  fit.excluded = static_cast<int>(x.size()) - fit.n;
  return points;
}

void refuse_too_few(const Fit& fit) {
  const int needed = static_cast<int>(fit.parameters.size()) + 1;
  if (fit.n >= needed) return;
  const ModelInfo& model = info(fit.model);
  std::string message = "the model `" + std::string(model.name) + "` needs at least " +
                        std::to_string(needed) + " points, and " + std::to_string(fit.n) +
                        (fit.n == 1 ? " is" : " are") + " usable";
  if (fit.excluded > 0)
    message += " (" + std::to_string(fit.excluded) + " excluded: not finite" +
               (model.positive_x_only ? ", or x not above 0)" : ")");
  throw InputError({}, message + "; record more points, or fit a model with fewer parameters");
}

// 1 - SSE / SST about the mean, both of the scaled y; NaN if y is constant.
double r_squared(std::span<const double> y, double squares) {
  double mean = 0.0;
  for (const double each : y) mean += each;
  mean /= static_cast<double>(y.size());
  double total = 0.0;
  for (const double each : y) total += (each - mean) * (each - mean);
  return total > 0.0 ? 1.0 - squares / total : Estimate::unknown;
}

// From (J^T J)^-1: covariance, standard errors and intervals.
void set_errors(Fit& fit, const Minimum& minimum, const Scaling& scaling) {
  const std::size_t count = fit.parameters.size();
  const std::span<const double> scale = scaling.parameters;
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
    for (const double each : minimum.inverse_normal)
      fit.covariance.push_back(each * minimum.squares / degrees);
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) fit.covariance[i * count + j] *= scale[i] * scale[j];
  const double t = numerics::student_t_quantile(0.975, degrees);
  for (std::size_t i = 0; i < count; ++i) {
    Estimate& parameter = fit.parameters[i];
    parameter.std_error = std::sqrt(fit.covariance[i * count + i]);
    parameter.ci95_low = parameter.estimate - t * parameter.std_error;
    parameter.ci95_high = parameter.estimate + t * parameter.std_error;
  }
}

Termination termination_of(const Minimum& minimum) {
  if (minimum.status == Minimum::Status::failed) return Termination::failed;
  if (minimum.status == Minimum::Status::out_of_iterations) return Termination::not_converged;
  return minimum.inverse_normal.empty() ? Termination::undetermined : Termination::converged;
}

}  // namespace

void settle(Fit& fit, const Minimum& minimum, const Scaling& scaling) {
  fit.termination = termination_of(minimum);
  fit.iterations = minimum.iterations;
  if (fit.termination == Termination::failed) return;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    fit.parameters[i].estimate = minimum.parameters[i] * scaling.parameters[i];
  fit.rmse = std::sqrt(minimum.squares / fit.n) * scaling.y_scale;
  fit.r2 = r_squared(scaling.y, minimum.squares);
  fit.durbin_watson = durbin_watson(minimum.residuals);
  if (fit.termination == Termination::converged) set_errors(fit, minimum, scaling);
}

std::string_view word(Termination termination) {
  switch (termination) {
    case Termination::converged: return "converged";
    case Termination::not_converged: return "not_converged";
    case Termination::undetermined: return "undetermined";
    case Termination::failed: return "failed";
  }
  return {};
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
  refuse_too_few(fit);

  const auto start = initial_guess(points.x, points.y, model);
  if (!start) return fit;
  std::vector<double> scale(start->size(), points.y_scale);
  if (has_shape(model)) scale.back() = 1.0;
  for (std::size_t i = 0; i < start->size(); ++i)
    fit.parameters[i].initial = (*start)[i] * scale[i];

  const Minimum minimum = minimise(points.x, points.y, model, *start, options.max_iterations);
  settle(fit, minimum, {points.y, points.y_scale, scale, options.residuals});
  return fit;
}

}  // namespace palpate::fit
