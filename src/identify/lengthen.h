// Lengthens the loading history of a scenario to the end of a measurement.
#pragma once

#include <optional>

#include "identify/scenario_curve.h"

namespace palpate::identify {

// Lengthens the step that ends the curve so that the loading history reaches `farthest` (a travel
// or a slide, m, or a time, s): the first `indent` with a travel, the first `slide`, or a last
// `hold`, `relax`, `creep` (its recovery) or `indent`. Nothing is shortened. Returns whether a step
// has changed; a step that ends at a force, and a last `retract` or `slide` over time, stay.
bool lengthen(CurveKind kind, scenario::Scenario& scenario, double farthest);

// The duration of the loading history, s; nothing if a step ends at a force, at a time that is not
// known.
[[nodiscard]] std::optional<double> duration(const scenario::Scenario& scenario);

}  // namespace palpate::identify
