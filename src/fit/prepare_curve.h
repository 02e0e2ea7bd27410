// A measurement made ready for a search: its points, their weights, and the curve of one rung.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "fit/identify.h"

namespace palpate::fit {

struct PreparedCurve {
  bool given = false;        // the scenario named the model
  double worst_error = 0.0;  // predicted, over the ranges
  std::unique_ptr<ScenarioCurve> curve;
  std::vector<double> x, measured;  // SI, of the points used
  std::vector<double> weights;      // of the residuals
  int left_out = 0;
  std::vector<std::string> notes;
};

// Throws what identify() throws of points and columns. Keeps references to family, unknowns, stop.
[[nodiscard]] PreparedCurve prepare_curve(const Measurement& measured,
                                          const scenario::Family& family,
                                          const std::vector<Unknown>& unknowns,
                                          const std::atomic<bool>& stop, Noise noise);

}  // namespace palpate::fit
