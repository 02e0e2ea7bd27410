// Errors and intervals of the parameters at a minimum.
#include "fit/fit_errors.h"

#include <cmath>

#include "fit/student.h"

namespace palpate::fit {
namespace {

double r_squared(std::span<const double> y, double squares) {
  double mean = 0.0;
  for (const double each : y) mean += each;
  mean /= static_cast<double>(y.size());
  double total = 0.0;
  for (const double each : y) total += (each - mean) * (each - mean);
  return total > 0.0 ? 1.0 - squares / total : Estimate::unknown;
}

void set_errors(Fit& fit, const Minimum& minimum, std::span<const double> scale) {
  const std::size_t count = fit.parameters.size();
  const double degrees = fit.n - static_cast<double>(count);
  const double variance = minimum.squares / degrees;
  const double t = student_t_quantile(0.975, degrees);
  fit.covariance.resize(count * count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      fit.covariance[i * count + j] =
          minimum.inverse_normal[i * count + j] * variance * scale[i] * scale[j];
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
  if (fit.termination == Termination::converged) set_errors(fit, minimum, scaling.parameters);
}

}  // namespace palpate::fit
