// Which points are used, where the search begins, and what its result is worth.
#include "fit/regression.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "fit/ceres_fit.h"
#include "fit/fit_errors.h"
#include "fit/initial.h"

namespace palpate::fit {
namespace {

// The points that can be used; y is divided by its largest size.
struct Points {
  std::vector<double> x;  // from the origin
  std::vector<double> y;
  double y_scale = 1.0;
};

Points usable(std::span<const double> x, std::span<const double> y, const Options& options,
              Fit& fit) {
  Points points;
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double from_origin = x[i] - options.x_origin;
    const bool outside = info(fit.model).positive_x_only && from_origin <= 0.0;
    if (!std::isfinite(from_origin) || !std::isfinite(y[i]) || outside) continue;
    points.x.push_back(from_origin);
    points.y.push_back(y[i]);
    largest = std::max(largest, std::abs(y[i]));
    fit.range_low = std::fmin(fit.range_low, x[i]);  // fmin passes over the NaN that it starts from
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  if (largest > 0.0) points.y_scale = largest;
  for (double& each : points.y) each /= points.y_scale;
  fit.n = static_cast<int>(points.x.size());
  fit.left_out = static_cast<int>(x.size()) - fit.n;
  return points;
}

void refuse_too_few(const Fit& fit) {
  const int needed = static_cast<int>(fit.parameters.size()) + 1;
  if (fit.n >= needed) return;
  const ModelInfo& model = info(fit.model);
  std::string message = "the model `" + std::string(model.name) + "` needs at least " +
                        std::to_string(needed) + " points, and " + std::to_string(fit.n) +
                        (fit.n == 1 ? " is" : " are") + " usable";
  if (fit.left_out > 0)
    message += " (" + std::to_string(fit.left_out) + " left out: not finite" +
               (model.positive_x_only ? ", or x not above 0)" : ")");
  throw InputError({}, message + "; record more points, or fit a model with fewer parameters");
}

}  // namespace

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
  const Points points = usable(x, y, options, fit);
  refuse_too_few(fit);

  const auto start = initial_guess(points.x, points.y, model);
  if (!start) return fit;
  std::vector<double> scale(start->size(), points.y_scale);
  if (has_shape(model)) scale.back() = 1.0;
  for (std::size_t i = 0; i < start->size(); ++i)
    fit.parameters[i].initial = (*start)[i] * scale[i];

  const Minimum minimum = minimise(points.x, points.y, model, *start, options.max_iterations);
  settle(fit, minimum, {points.y, points.y_scale, scale});
  return fit;
}

double value(const Fit& fit, double x) {
  std::vector<double> parameters;
  for (const Estimate& parameter : fit.parameters) parameters.push_back(parameter.estimate);
  return value(fit.model, parameters, x - fit.x_origin);
}

}  // namespace palpate::fit
