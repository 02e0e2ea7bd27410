// Prepares a measurement for the search: points, weights, and the curve of one model.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "identify/identify.h"

namespace palpate::identify {

struct PreparedCurve {
  bool given = false;        // the scenario names the model
  double worst_error = 0.0;  // relative, the largest estimate over the ranges
  std::unique_ptr<ScenarioCurve> curve;
  std::vector<double> x, measured;  // SI, of the points used
  std::vector<double> weights;      // of the residuals, 1/SI
  double rows_each = 1.0;           // largest number of rows of which a point is the mean
  int excluded = 0;                 // measured points that are not used
  std::vector<std::string> notes;
};

// Throws InputError like identify(). `family` and `unknowns` must outlive the result.
[[nodiscard]] PreparedCurve prepare_curve(const Measurement& measured,
                                          const scenario::Family& family,
                                          const std::vector<Unknown>& unknowns, Noise noise);

}  // namespace palpate::identify
