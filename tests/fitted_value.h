// The value of a fitted curve.
#pragma once

#include <vector>

#include "fit/regression.h"

namespace palpate::test {

// The fitted curve of a model in models() at x, from which x_origin is subtracted here.
inline double value(const fit::Fit& fit, double x) {
  std::vector<double> parameters;
  for (const fit::Estimate& parameter : fit.parameters) parameters.push_back(parameter.estimate);
  return fit::value(fit.model, parameters, x - fit.x_origin);
}

}  // namespace palpate::test
