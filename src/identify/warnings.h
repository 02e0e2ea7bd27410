// Sentences on why the estimates may be wrong.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/identify.h"
#include "scenario/resolved.h"

namespace palpate::identify {

struct WeightedResiduals {
  std::span<const double> values;  // in the order of the points
  double noise = 0.0;              // their standard deviation
  std::string model;               // the word of the model
};

// On correlated residuals, few independent points, R^2 below 0.9, estimates at a bound, the model's
// own error at the estimates, and neglected inertia.
[[nodiscard]] std::vector<std::string> warnings_of(const Identification& found,
                                                   const WeightedResiduals& residuals,
                                                   const scenario::Resolved& with);

// On the default block where the scenario of a press names no body, and by how much its force at
// the deepest is above that of a half-space, with these values of the unknowns (SI), if by over 2
// %. Empty otherwise. What nobody has said belongs to the intervals.
struct DefaultBody {
  std::string text;
  double change = 0.0;
};
[[nodiscard]] DefaultBody default_body(ScenarioCurve& curve, const scenario::Family& family,
                                       std::span<const double> values);

}  // namespace palpate::identify
